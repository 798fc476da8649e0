// SPDX-License-Identifier: GPL-3.0-or-later
// What a survey says of logs whose troubles were made by hand.
#include "eyeslam/replay/log_survey.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "eyeslam/replay/log_selection.h"
#include "support/written_log.h"

namespace eyeslam::replay {
namespace {

using support::headed;
using support::kLogStart;
using support::WrittenLog;

LogSurvey surveyOf(const std::string& path)
{
  SortedLog log(path);
  LogSurveyor surveyor;
  while (const auto event = log.next()) surveyor.add(*event);
  return surveyor.survey(log);
}

ChannelFindings only(const LogSurvey& survey)
{
  EXPECT_EQ(survey.channels.size(), 1U);
  return survey.channels.front();
}

std::int64_t at(int millisecond) { return kLogStart + 1000 * millisecond; }

void addStates(WrittenLog& log, const std::vector<int>& seqs, std::int64_t session = 7)
{
  for (std::size_t i = 0; i < seqs.size(); ++i) {
    const std::int64_t utime = at(static_cast<int>(i));
    log.add(headed<micron_state_t>(utime, seqs[i], session), utime);
  }
}

TEST(MessageTypes, AreToldApartByTheirFingerprints)
{
  std::set<std::int64_t> fingerprints;
  for (const MessageType& type : messageTypes()) fingerprints.insert(type.fingerprint);
  EXPECT_EQ(fingerprints.size(), messageTypes().size());
  EXPECT_EQ(typeOfChannel("MICRON_STATE")->name, "micron_state_t");
  EXPECT_EQ(typeOfChannel("MICRON_STAT"), nullptr);
}

TEST(LogSurvey, CountsWhatIsMissingRepeatedAndOvertaken)
{
  WrittenLog log;
  addStates(log, {0, 1, 2, 5, 6, 6, 4, 9});  // 3, 7 and 8 never came; 6 came twice; 4 came after 6
  const ChannelFindings states = only(surveyOf(log.finish()));
  EXPECT_EQ(states.type, "micron_state_t");
  EXPECT_EQ(states.events, 8);
  EXPECT_EQ(states.lost, 3);
  EXPECT_EQ(states.repeated, 1);
  EXPECT_EQ(states.overtaken, 1);
  EXPECT_EQ(states.sessions, 1);
}

TEST(LogSurvey, LosesNothingWhereASenderStartsAnewOrTheLogBeganLate)
{
  WrittenLog log;
  addStates(log, {500, 501, 502}, 7);
  addStates(log, {0, 1, 2}, 8);
  const ChannelFindings states = only(surveyOf(log.finish()));
  EXPECT_EQ(states.lost, 0);
  EXPECT_EQ(states.sessions, 2);
}

TEST(LogSurvey, ShowsTheLongestGapAndWhereItBegins)
{
  WrittenLog log;
  for (int i = 0; i < 100; ++i) log.add(headed<micron_state_t>(at(i), i), at(i < 60 ? i : i + 40));
  log.add("OTHER", {1}, at(80));
  const LogSurvey survey = surveyOf(log.finish());
  const ChannelFindings& states = survey.channels.front();
  EXPECT_EQ(states.gap.us, 41'000);
  EXPECT_EQ(states.gap.since_us, 59'000);
  EXPECT_DOUBLE_EQ(states.rate, 99 / 0.139);
  EXPECT_EQ(survey.gap.us, 21'000);  // the other channel spoke meanwhile
  EXPECT_EQ(survey.gap.since_us, 59'000);
  EXPECT_EQ(survey.end - survey.start, 139'000);
}

TEST(LogSurvey, RefusesAChangedTypeByNameAndTellsForeignFromCut)
{
  WrittenLog log;
  support::Bytes changed = support::encodedMessage(headed<micron_state_t>(at(0), 0));
  changed[3] ^= 1U;  // the fingerprint of a type with other fields
  support::Bytes cut = support::encodedMessage(headed<laser_state_t>(at(0), 0));
  cut.pop_back();
  log.add("MICRON_STATE", changed, at(0));
  log.add("LASER_STATE", cut, at(0));
  log.add("SOMEBODYS", changed, at(0));
  log.add("ELSEWHERE", support::encodedMessage(headed<tool_tip_t>(at(0), 0)), at(0));  // ours on another channel
  const LogSurvey survey = surveyOf(log.finish());
  ASSERT_EQ(survey.refused().size(), 1U);
  EXPECT_EQ(survey.refused()[0].channel, "MICRON_STATE");
  EXPECT_EQ(survey.refused()[0].changed_type, 1);
  EXPECT_EQ(survey.refused()[0].fingerprint, micron_state_t::getHash() ^ (std::int64_t{1} << 32U));
  EXPECT_NE(migrationOf("micron_state_t").find("no migration of micron_state_t"), std::string::npos);
  ASSERT_EQ(survey.channels.size(), 4U);  // by name
  EXPECT_EQ(survey.channels[0].type, "tool_tip_t");
  EXPECT_EQ(survey.channels[1].undecodable, 1);
  EXPECT_EQ(survey.channels[3].type, "");
  EXPECT_EQ(survey.channels[3].events, 1);
}

TEST(LogSurvey, FindsTimesThatCannotBe)
{
  WrittenLog log;
  const auto add = [&log](int seq, std::int64_t utime, std::int64_t sent, std::int64_t logged) {
    micron_state_t state = headed<micron_state_t>(utime, seq);
    state.utime_sent = sent;
    log.add(state, logged);
  };
  add(0, at(0), at(2), at(2));
  add(1, 0, at(3), at(3));       // none
  add(2, at(4), 0, at(4));       // none
  add(3, at(6), at(5), at(5));   // not yet happened
  add(4, at(1), at(7), at(7));   // backwards
  add(5, at(8), at(20), at(9));  // another clock
  add(6, at(9), at(10), at(10));
  const ChannelFindings states = only(surveyOf(log.finish()));
  EXPECT_EQ(states.utime_missing, 2);
  EXPECT_EQ(states.from_future, 1);
  EXPECT_EQ(states.utime_backwards, 1);
  EXPECT_EQ(states.sent_later, 1);
  EXPECT_EQ(states.age.count(), 5);
  EXPECT_EQ(states.age.lowest(), -1000);
  EXPECT_EQ(states.age.highest(), 12'000);
  EXPECT_EQ(states.transport.lowest(), -11'000);
}

TEST(LogSurvey, KeepsWhatTheMarksSay)
{
  WrittenLog log;
  mark_t mark = headed<mark_t>(at(0), 0);
  mark.sender = "eyeslam-trial";
  mark.version = "0.1.0";
  mark.configuration = "aid: hard\n";
  log.add(mark, at(0));
  mark.kind = mark_t::NOTE;
  mark.note = "counts from here";
  log.add(mark, at(500));
  const LogSurvey survey = surveyOf(log.finish());
  ASSERT_EQ(survey.marks.size(), 2U);
  EXPECT_EQ(survey.marks[0].mark.configuration, "aid: hard\n");
  EXPECT_EQ(survey.marks[1].since_us, 500'000);
  EXPECT_EQ(survey.marks[1].mark.note, "counts from here");
}

TEST(LogSurvey, StaysSmallWhereEveryEventHasAChannelOfItsOwn)
{
  WrittenLog log;
  constexpr int kEvents = 2000;
  for (int i = 0; i < kEvents; ++i) log.add("C" + std::to_string(i), {1}, at(i));
  const LogSurvey survey = surveyOf(log.finish());
  EXPECT_EQ(survey.channels.size(), LogSurveyor::kMostChannels);
  EXPECT_EQ(survey.left_out, kEvents - static_cast<std::int64_t>(LogSurveyor::kMostChannels));
  EXPECT_EQ(survey.events, kEvents);
}

// Any cut of [0, 10) s into parts has each event in one of them.
RC_GTEST_PROP(LogSelection, PartsAddUpToTheWhole, ())
{
  const double cut = *rc::gen::inRange(1, 9999) * 1e-3;
  LogSelection first({std::nullopt, cut, ""}), second({cut, std::nullopt, ""}),
      states({std::nullopt, std::nullopt, "S.*"}), others({std::nullopt, std::nullopt, "[^S].*"});
  for (std::int64_t since = 0; since < 10'000'000; since += 250'000) {
    SortedEvent event;
    event.since_us = since + *rc::gen::inRange<std::int64_t>(0, 2);
    event.event.channel = since % 500'000 == 0 ? "STATE" : "MARK";
    RC_ASSERT(first.takes(event) != second.takes(event));
    RC_ASSERT(states.takes(event) != others.takes(event));
  }
}

TEST(LogSelection, RefusesWhatIsNoPart)
{
  EXPECT_THROW(LogSelection({2.0, 1.0, ""}), std::invalid_argument);
  EXPECT_THROW(LogSelection({std::nan(""), std::nullopt, ""}), std::invalid_argument);
  EXPECT_THROW(LogSelection({std::nullopt, std::nullopt, "("}), std::invalid_argument);
}

RC_GTEST_PROP(DurationStatistics, KnowsQuantilesWithinOnePercent, ())
{
  auto durations =
      *rc::gen::nonEmpty(rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(1, 100'000'000)));
  DurationStatistics statistics;
  for (const std::int64_t duration : durations) statistics.add(duration);
  std::sort(durations.begin(), durations.end());
  for (const double share : {0.01, 0.5, 0.99, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(durations.size())));
    const double exact = static_cast<double>(durations[std::max<std::size_t>(rank, 1) - 1]);
    RC_ASSERT(std::abs(statistics.quantile(share) - exact) <= 0.0101 * exact);
  }
  RC_ASSERT(statistics.lowest() == durations.front());
  RC_ASSERT(statistics.highest() == durations.back());
}

}  // namespace
}  // namespace eyeslam::replay
