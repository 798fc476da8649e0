// SPDX-License-Identifier: GPL-3.0-or-later
// Short trials in lock step, and their servo again from their logs.
#include "eyeslam/replay/servo_replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "eyeslam/configuration/listing.h"
#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/record_messages.h"
#include "support/broken_messages.h"
#include "support/short_trial.h"
#include "support/written_log.h"

namespace eyeslam::replay {
namespace {

using support::KeptEvent;
using support::ShortTrial;
using support::traced;
using ::testing::HasSubstr;
using Changes = std::vector<configuration::Assignment>;

struct Replayed {
  explicit Replayed(const std::vector<KeptEvent>& events, const Changes& changes = {}) : servo(changes, comparison)
  {
    for (const KeptEvent& kept : events) {
      servo.take({kept.event(), kept.utime, kept.utime - events.front().utime, false, false});
    }
    servo.finish();
  }

  const ChannelComparison& on(const std::string& channel) const
  {
    const auto found = std::find_if(comparison.channels().begin(), comparison.channels().end(),
                                    [&](const ChannelComparison& one) { return one.channel == channel; });
    if (found == comparison.channels().end()) throw std::out_of_range(channel);
    return *found;
  }

  Comparison comparison;
  ServoReplay servo;
};

std::int64_t countOn(const ShortTrial& trial, const std::string& channel)
{
  return std::count_if(trial.events.begin(), trial.events.end(),
                       [&channel](const KeptEvent& event) { return event.channel == channel; });
}

TEST(ServoReplay, SendsTheSameBytesAsInATracing)
{
  const Replayed again(traced().events);
  EXPECT_EQ(again.servo.lacking(), "");
  EXPECT_FALSE(again.servo.isLive());
  EXPECT_THAT(again.servo.about(), HasSubstr("eyeslam-trial 1.2.3 in lock step: short, aid=hard, seed 3"));
  EXPECT_TRUE(again.comparison.isIdentical());
  for (const char* channel : {"MICRON_COMMAND", "SERVO_STATUS", "REGISTRATION", "LASER_COMMAND"}) {
    EXPECT_EQ(again.on(channel).compared, countOn(traced(), channel)) << channel;
  }
  EXPECT_GT(again.on("MICRON_COMMAND").compared, 5000);
}

TEST(ServoReplay, SendsTheSameBytesAsWithALaser)
{
  ShortTrial trial("task: laser\naid: automated\nduration_s: 2\nlaser: {map_s: 1}\n");
  const Replayed again(trial.run().events);
  EXPECT_TRUE(again.comparison.isIdentical());
  EXPECT_GT(again.on("LASER_COMMAND").compared, 100);
  EXPECT_GT(again.on("BURN_PLAN").compared, 0) << "no plan was in force";
}

TEST(ServoReplay, ComputesEachOfTwoTrialsThatWereJoined)
{
  support::WrittenLog joined;
  for (int i = 0; i < 2; ++i) {
    for (const KeptEvent& event : traced().events) {
      joined.add(event.channel, support::Bytes(event.bytes.begin(), event.bytes.end()), event.utime);
    }
  }
  Comparison comparison;
  ServoReplay servo({}, comparison);
  SortedLog log(joined.finish());
  while (const auto event = log.next()) servo.take(*event);
  servo.finish();
  EXPECT_TRUE(comparison.isIdentical());
  std::int64_t commands = 0;
  for (const ChannelComparison& channel : comparison.channels())
    commands += channel.channel == "MICRON_COMMAND" ? channel.identical : 0;
  EXPECT_EQ(commands, 2 * countOn(traced(), "MICRON_COMMAND"));
}

TEST(ServoReplay, FindsTheFieldAndTimeOfAChangedByte)
{
  std::vector<KeptEvent> events = traced().events;
  const auto changed = std::find_if(events.begin() + static_cast<std::ptrdiff_t>(events.size() / 2), events.end(),
                                    [](const KeptEvent& event) { return event.channel == "MICRON_COMMAND"; });
  constexpr std::size_t kUtimeImage = 8 + 4 * 8;  // behind the fingerprint and the header: utime_image
  changed->bytes[kUtimeImage + 7] = static_cast<char>(changed->bytes[kUtimeImage + 7] ^ 4);
  const Replayed again(events);
  const ChannelComparison& commands = again.on("MICRON_COMMAND");
  EXPECT_EQ(commands.compared - commands.identical, 1);
  ASSERT_TRUE(commands.first);
  EXPECT_EQ(commands.first->field, "utime_image_us");
  EXPECT_EQ(commands.first->utime, changed->utime);
  EXPECT_EQ(commands.first->event, changed->number);
  EXPECT_EQ(commands.largest, 4.0);
  EXPECT_TRUE(again.on("SERVO_STATUS").isIdentical());
}

TEST(ServoReplay, AnswersWhatAnotherSettingWouldHaveDone)
{
  const Replayed again(traced().events, {configuration::parseSetting("servo.cycle.predicts_null=false")});
  EXPECT_FALSE(again.comparison.isIdentical());
  EXPECT_GT(again.servo.goals().largest(), 0.1);
  EXPECT_LT(again.servo.goals().largest(), 5000.0);
  const Replayed same(traced().events, {configuration::parseSetting("aid=hard")});
  EXPECT_TRUE(same.comparison.isIdentical()) << "it is what was recorded";
}

TEST(ServoReplay, RefusesToChangeWhatIsRecordedAndKeysThatItDoesNotKnow)
{
  for (const char* setting : {"motion=jerky", "hardware.camera.fps=60", "servo.cycle.no_such=1"}) {
    EXPECT_THROW(Replayed(traced().events, {configuration::parseSetting(setting)}), configuration::ConfigurationError)
        << setting;
  }
}

TEST(ServoReplay, SaysWhatALogLacks)
{
  std::vector<KeptEvent> events = traced().events;
  events.erase(events.begin());
  EXPECT_THAT(Replayed(events).servo.lacking(), HasSubstr("no MARK START"));
  ShortTrial bare("task: trace\naid: none\n", 3, traced().scene);
  EXPECT_THAT(Replayed(bare.run().events).servo.lacking(), HasSubstr("by hand alone"));

  events = traced().events;
  KeptEvent& state =
      *std::find_if(events.begin(), events.end(), [](const auto& e) { return e.channel == "MICRON_STATE"; });
  state.bytes[0] = static_cast<char>(state.bytes[0] ^ 1);
  EXPECT_THROW(Replayed{events}, ReplayError);
}

TEST(ServoReplay, MissesWhatWasRecordedBesidesAndFindsWhatWasNot)
{
  std::vector<KeptEvent> events = traced().events;
  const auto command =
      std::find_if(events.begin(), events.end(), [](const auto& e) { return e.channel == "MICRON_COMMAND"; });
  const KeptEvent twice = *command;
  events.insert(command, twice);
  const auto status =
      std::find_if(events.begin(), events.end(), [](const auto& e) { return e.channel == "SERVO_STATUS"; });
  events.erase(status);
  const Replayed again(events);
  EXPECT_EQ(again.on("MICRON_COMMAND").missing, 1);
  EXPECT_EQ(again.on("SERVO_STATUS").extra, 1);
}

TEST(ServoReplay, LeavesTheLastMillisecondOfALogThatWasCutOffOut)
{
  std::vector<KeptEvent> events = traced().events;
  const auto last =
      std::find_if(events.rbegin() + 100, events.rend(), [](const auto& e) { return e.channel == "MICRON_COMMAND"; });
  events.erase(last.base() - 1, events.end());
  EXPECT_TRUE(Replayed(events).comparison.isIdentical());
}

// A log of live programs, as far as a servo can tell: other sessions' times, and the configuration of eyeslam-servo.
TEST(ServoReplay, FollowsALiveServoByTheTimesOfItsCommands)
{
  const ShortTrial& trial = traced();
  std::vector<KeptEvent> events = trial.events;
  mark_t mark{};
  ASSERT_TRUE(messaging::decode(events.front().event().data, events.front().event().size, mark));
  mark.sender = "eyeslam-servo";
  mark.note = "";
  mark.configuration = configuration::yamlOf(
      servo::ServoConfiguration{trial.setting.servo, trial.setting.preparation, trial.setting.calibration},
      configuration::YamlComments::left_out);
  events.front().bytes.resize(static_cast<std::size_t>(mark.getEncodedSize()));
  mark.encode(events.front().bytes.data(), 0, static_cast<int>(events.front().bytes.size()));
  const Replayed again(events);
  EXPECT_TRUE(again.servo.isLive());
  const ChannelComparison& commands = again.on("MICRON_COMMAND");
  EXPECT_GE(commands.compared, countOn(trial, "MICRON_COMMAND") - 10);
  EXPECT_LE(commands.extra, 10);
  EXPECT_GT(again.servo.goals().count(), 1000);
  EXPECT_LT(again.servo.goals().quantile(0.5), 5.0);  // um
}

// @return events of a trial, a hundredth of them broken, and some gone or at another time
std::vector<KeptEvent> broken(std::vector<KeptEvent> events, std::mt19937& random)
{
  for (std::size_t i = 1; i < events.size(); ++i) {
    if (random() % 100 == 0) support::breakMessage(events[i].bytes, random);
    if (random() % 2000 == 0) events[i].utime += static_cast<std::int64_t>(random() % 4'000'000) - 2'000'000;
    if (random() % 500 == 0) events.erase(events.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return events;
}

TEST(ServoReplay, AndTheJudgeComeToAnEndWithABrokenTrial)
{
  std::mt19937 random(5);
  for (int i = 0; i < 4; ++i) {
    const std::vector<KeptEvent> events = broken(traced().events, random);
    try {
      const Replayed again(events);
      EXPECT_GT(again.on("MICRON_COMMAND").compared, 0);
    } catch (const ReplayError& error) {
      EXPECT_STRNE(error.what(), "");
    }
    trials::TrialJudge judge(traced().scene);
    for (const KeptEvent& kept : events) judge.take(kept.event());
    ASSERT_TRUE(judge.isTrial());
    EXPECT_GE(judge.record().score.hold_events, 0);
  }
}

TEST(ServoReplay, AReportIsMadeOfALaserTrialThatLostItsPlan)
{
  ShortTrial trial("task: laser\naid: manual\nduration_s: 20\n");
  trials::TrialJudge judge(trial.scene);
  for (const KeptEvent& kept : trial.run().events)
    if (kept.channel != "BURN_PLAN") judge.take(kept.event());
  const trials::TrialRecord record = judge.record();
  EXPECT_GT(record.score.fired, 0) << "nothing was burnt";
  EXPECT_TRUE(record.pulses.empty()) << "nobody knows where they were meant to go";
}

}  // namespace
}  // namespace eyeslam::replay
