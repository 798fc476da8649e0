// SPDX-License-Identifier: GPL-3.0-or-later
// Whole trials in lock step, seconds each: the real tracker on small rendered frames, nothing but messages between all.
#include "eyeslam/trials/trial.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "eyeslam/configuration/listing.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/trials/error_figures.h"
#include "eyeslam/trials/lock_step_time.h"
#include "eyeslam/trials/trial_marks.h"
#include "support/encoded_message.h"
#include "support/short_trial.h"

namespace eyeslam::trials {
namespace {

using support::KeptEvent;
using support::ShortTrial;
using support::traced;
using ::testing::Contains;
using ::testing::HasSubstr;

template <class Message>
std::vector<Message> messagesOf(const ShortTrial& trial, const std::string& channel)
{
  std::vector<Message> messages;
  for (const KeptEvent& kept : trial.events) {
    if (kept.channel != channel) continue;
    messages.emplace_back();
    EXPECT_TRUE(kept.read(messages.back())) << channel;
  }
  return messages;
}

void expectSameRecord(const TrialRecord& a, const TrialRecord& b)
{
  EXPECT_EQ(rowOf(a.score), rowOf(b.score));
  EXPECT_EQ(a.score.more, b.score.more);
  EXPECT_EQ(a.configuration, b.configuration);
  EXPECT_EQ(a.variant, b.variant);
  EXPECT_EQ(a.path, b.path);
  ASSERT_EQ(a.tip.size(), b.tip.size());
  for (std::size_t i = 0; i < a.tip.size(); ++i) ASSERT_EQ(a.tip[i].error, b.tip[i].error);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) EXPECT_EQ(a.events[i].what, b.events[i].what);
  EXPECT_EQ(a.pose_errors_px, b.pose_errors_px);
  EXPECT_EQ(a.frame_to_command_s, b.frame_to_command_s);
  EXPECT_EQ(cv::norm(a.retina.bgr, b.retina.bgr, cv::NORM_INF), 0.0);
}

TEST(Trial, SendsTheSameBytesTwice)
{
  ShortTrial again("task: trace\naid: hard\n", 3, traced().scene);
  again.run();
  ASSERT_GT(again.events.size(), 10'000U);
  EXPECT_TRUE(again.events == traced().events);
}

TEST(Trial, SendsOtherBytesForAnotherSeed)
{
  const std::string bare = "task: trace\naid: none\n";
  ShortTrial other(bare, 4, traced().scene), same(bare, 3, traced().scene);
  EXPECT_FALSE(other.run().events == same.run().events);
}

TEST(TrialJudge, SaysOfALogWhatItSaidOfTheTrial)
{
  TrialJudge judge;  // that makes the scene itself, from the log
  for (const KeptEvent& event : traced().events) judge.take(event.event());
  ASSERT_TRUE(judge.isTrial());
  expectSameRecord(judge.record(), traced().judge.record());
}

TEST(TrialJudge, PassesOverWhatIsNotItsOwn)
{
  const ShortTrial& trial = traced();
  TrialJudge judge(trial.scene);
  const KeptEvent broken{0, trial.events.front().utime, "TRUTH", "not a message"}, other{0, 0, "OTHER", "x"};
  for (const KeptEvent& event : trial.events) {
    judge.take(broken.event());
    judge.take(event.event());
    judge.take(other.event());
  }
  expectSameRecord(judge.record(), trial.judge.record());
  EXPECT_THROW(TrialJudge().record(), std::logic_error);
}

TEST(TrialJudge, TellsOfItsMapHowMuchOfTheTrueVesselsItHas)
{
  const MapCoverage& map = traced().judge.record().map;
  EXPECT_GT(map.coverage[2].value(), 0.7);  // seconds after the first frame
  EXPECT_LE(map.coverage[2].value(), 1.0);
  EXPECT_GT(map.coverage[2].value(), map.coverage[0].value_or(0.0)) << "wide vessels are easier";
  EXPECT_GT(map.precision.value(), 0.6);
}

TEST(TrialJudge, DrawsBurnsOutByTheWayOfTheSpot)
{
  ShortTrial trial("task: laser\naid: automated\nduration_s: 2\nlaser: {map_s: 1}\n");
  const TrialRecord record = trial.run().judge.record();
  ASSERT_FALSE(record.pulses.empty());
  const double burn = record.targets.front().burn;
  for (const PulseRecord& pulse : record.pulses) {
    EXPECT_GT(pulse.length, burn);
    EXPECT_LT(pulse.length, burn + 60e-6);  // of tremor that is left, within a pulse
  }
}

// What the judge says at the end of a trial whose tip had been at these places, as long at each.
TipSample judgedAt(const std::vector<Eigen::Vector2d>& places)
{
  constexpr std::size_t kCounted = 900;  // ms at the end
  TrialJudge judge(traced().scene);
  const auto total =
      static_cast<std::size_t>(std::count_if(traced().events.begin(), traced().events.end(), [](const KeptEvent& kept) {
        return kept.channel == messaging::channelOf<truth_t>();
      }));
  std::size_t number = 0;
  for (const KeptEvent& kept : traced().events) {
    truth_t truth{};
    if (kept.channel != messaging::channelOf<truth_t>()) {
      judge.take(kept.event());
      continue;
    }
    EXPECT_TRUE(kept.read(truth));
    const std::size_t left = total - ++number;
    const std::size_t at = left < kCounted ? (kCounted - 1 - left) * places.size() / kCounted : 0;
    std::copy_n(places[at].data(), 2, truth.tip);
    const support::Bytes bytes = support::encodedMessage(truth);
    judge.take({kept.number, kept.utime, kept.channel, bytes.data(), bytes.size()});
  }
  return judge.record().tip.back();
}

TEST(TrialJudge, WantsTheTipOnThePathBesideItAndOnAnyVesselBeyondItsEnds)
{
  const TrialScene& scene = *traced().scene;
  const Eigen::Vector2d end = scene.path().back().head<2>(), near = scene.path()[scene.path().size() - 15].head<2>();
  const Eigen::Vector2d on = (end - near).normalized(), aside(-on.y(), on.x());
  // Beside the path another vessel would be no better: told as it is.
  const TipSample beside = judgedAt({near + 10e-6 * aside});
  EXPECT_TRUE(beside.on_path);
  EXPECT_NEAR(beside.error, 10e-6, 1e-6);
  double nearest_vessel = 1.0, farthest_vessel = 0.0;
  for (const double ahead : {100e-6, 200e-6, 300e-6}) {
    const Eigen::Vector2d place = end + ahead * on;
    const TipSample beyond = judgedAt({place});
    EXPECT_FALSE(beyond.on_path);
    EXPECT_EQ(beyond.error, std::min(scene.centrelineDistance(place), (place - end).norm()));
    nearest_vessel = std::min(nearest_vessel, beyond.error);
    farthest_vessel = std::max(farthest_vessel, (place - end).norm());
  }
  EXPECT_LT(nearest_vessel, 0.5 * farthest_vessel) << "the vessel goes on, so that it must have been looked for";
  // A vessel that turns beyond an end passes beside the path again.
  const Eigen::Vector2d again = scene.path()[scene.path().size() / 2].head<2>() + 200e-6 * aside;
  EXPECT_TRUE(judgedAt({again}).on_path);
  EXPECT_FALSE(judgedAt({end + 300e-6 * on, again}).on_path);
  EXPECT_TRUE(judgedAt({end + 300e-6 * on, near, again}).on_path);
}

double more(const TrialRecord& record, const std::string& name)
{
  for (const auto& [key, value] : record.score.more)
    if (key == name) return value;
  ADD_FAILURE() << "no score " << name;
  return -1.0;
}

TEST(Trial, TellsOfTheHandOfLatenciesAndOfTheTimeBesideThePath)
{
  const TrialRecord record = traced().judge.record();
  EXPECT_GT(more(record, "hand_travel_mm"), 1.0);        // tremor of 50 um at 10 Hz for a second
  EXPECT_GT(more(record, "tip_off_hand_rms_um"), 50.0);  // which the manipulator takes off
  EXPECT_GT(more(record, "pose_age_median_ms"), 13.0);
  EXPECT_LT(more(record, "pose_age_p95_ms"), 21.0);
  EXPECT_GE(more(record, "frame_to_command_median_ms"), more(record, "pose_age_median_ms"));
  const auto beyond =
      std::count_if(record.tip.begin(), record.tip.end(), [](const TipSample& s) { return !s.on_path; });
  EXPECT_EQ(more(record, "beyond_path_share"), static_cast<double>(beyond) / static_cast<double>(record.tip.size()));
}

TEST(Trial, ScoresTheAidedHandAgainstTheTruth)
{
  const TrialRecord record = traced().judge.record();
  EXPECT_EQ(record.score.scenario, "short");
  EXPECT_EQ(record.score.seed, 3U);
  EXPECT_EQ(record.score.duration_s, 1.0);
  EXPECT_EQ(record.tip.size(), 1000U);
  EXPECT_LT(*record.score.rms_um, 60.0);
  EXPECT_EQ(record.score.hold_events + record.score.fault_events, 0);
  EXPECT_EQ(*record.score.tracked_fraction, 1.0);
  EXPECT_LT(record.left_out, 0.02) << "in lock step the tracker has the time it needs";
  EXPECT_FALSE(record.passed) << "nothing was to go wrong";
}

TEST(Trial, IsMarkedAtItsStartWhereItCountsFromAndAtItsEnd)
{
  const ShortTrial& trial = traced();
  const std::vector<mark_t> marks = messagesOf<mark_t>(trial, "MARK");
  ASSERT_EQ(marks.size(), 3U);
  EXPECT_EQ(trial.events.front().channel, "MARK");
  EXPECT_EQ(marks[0].kind, mark_t::START);
  EXPECT_EQ(marks[0].utime, kStart_us);
  EXPECT_EQ(marks[0].sender, "eyeslam-trial");
  EXPECT_EQ(marks[0].version, "1.2.3");
  EXPECT_EQ(marks[0].configuration_hash, configuration::hashOf(trial.setting));
  EXPECT_EQ(configuration::hashOf(settingOf("short", marks[0].configuration)), marks[0].configuration_hash);
  const auto name = TrialName::parse(marks[0].note);
  ASSERT_TRUE(name);
  EXPECT_EQ(name->scenario, "short");
  EXPECT_EQ(name->variant, "aid=hard");
  EXPECT_EQ(name->seed, 3U);
  EXPECT_EQ(marks[1].kind, mark_t::NOTE);
  EXPECT_EQ(marks[1].note, kCountsFromHere);
  EXPECT_EQ(marks[2].kind, mark_t::STOP);
  EXPECT_EQ(marks[2].note, "");
  EXPECT_EQ(marks[2].utime - marks[1].utime, 1'000'000);
  EXPECT_FALSE(TrialName::parse("counts from here"));
  EXPECT_FALSE(TrialName::parse("{\"scenario\": 3, \"seed\": -1}"));
}

TEST(Trial, HasEachMillisecondsMessagesUnderItsTimeAndItsTruthOnce)
{
  const ShortTrial& trial = traced();
  EXPECT_TRUE(std::is_sorted(trial.events.begin(), trial.events.end(),
                             [](const KeptEvent& a, const KeptEvent& b) { return a.utime < b.utime; }));
  for (std::size_t i = 0; i < trial.events.size(); ++i) ASSERT_EQ(trial.events[i].number, static_cast<std::int64_t>(i));
  const std::vector<truth_t> truths = messagesOf<truth_t>(trial, "TRUTH");
  for (std::size_t i = 0; i < truths.size(); ++i)
    ASSERT_EQ(truths[i].utime, kStart_us + 1000 * static_cast<std::int64_t>(i));
  std::set<std::string> channels;
  for (const KeptEvent& event : trial.events) channels.insert(event.channel);
  for (const char* channel : {"MARK", "MICRON_STATE", "MICRON_COMMAND", "LASER_STATE", "TRUTH", "RETINA_POSE",
                              "TOOL_TIP", "VESSEL_MAP", "OPERATOR", "REGISTRATION", "SERVO_STATUS"})
    EXPECT_THAT(channels, Contains(channel));
}

TEST(Trial, LetsOutWhatItsListenerThrows)
{
  const ShortTrial trial("task: trace\naid: none\n", 3, traced().scene);
  int heard = 0;
  Trial running(trial.setting, trial.name, "1.2.3", *trial.scene, [&heard](const files::LogEvent&) {
    if (++heard == 20) throw std::runtime_error("disk full");
  });
  EXPECT_THROW(
      {
        for (int i = 0; i < 100; ++i) running.step();
      },
      std::runtime_error);
}

/// What a judge says of a trial's log whose scenario had been another, and whose messages somebody may have altered.
template <class Alter>
TrialRecord judged(const ShortTrial& trial, const std::string& yaml, const Alter& alter)
{
  const ShortTrial wants(yaml, 3, trial.scene);
  TrialJudge judge(trial.scene);
  for (KeptEvent kept : trial.events) {
    mark_t mark{};
    if (kept.channel == "MARK" && kept.read(mark) && mark.kind == mark_t::START) {
      mark.configuration = configuration::yamlOf(wants.setting, configuration::YamlComments::left_out);
      kept.write(mark);
    }
    alter(kept);
    judge.take(kept.event());
  }
  return judge.record();
}

const std::string kLost = "aid: hard\nduration_s: 1.5\nfault: {kind: operator_lost, ";

const ShortTrial& operatorLost()
{
  static const ShortTrial trial = [] {
    ShortTrial lost(kLost + "for_s: 5, at_s: 0.5, must: hold, reason: operator_stale}\n", 3, traced().scene);
    lost.run();
    return lost;
  }();
  return trial;
}

TEST(Trial, HoldsWithItsReasonWhenTheOperatorIsLostAndPassesWhereThatMustBe)
{
  const TrialRecord record = operatorLost().judge.record();
  EXPECT_TRUE(record.passed.value_or(false)) << record.verdict;
  EXPECT_EQ(record.score.hold_events, 1);
  const auto hold = std::find_if(record.events.begin(), record.events.end(),
                                 [](const TrialEvent& event) { return event.what == "hold"; });
  ASSERT_NE(hold, record.events.end());
  EXPECT_EQ(hold->reason, "operator_stale");
  EXPECT_GT(hold->t_s, 0.5);
  EXPECT_LT(hold->t_s, 0.8);
  EXPECT_FALSE(hold->warning) << "it was to be so";
}

TEST(Trial, FailsWhereWhatHappenedIsNotWhatMustOrComesTooLate)
{
  for (const char* must :
       {"for_s: 5, at_s: 0.5, must: fault}\n", "for_s: 5, at_s: 0.5, must: hold, reason: pose_old}\n",
        "for_s: 5, at_s: 0.5, must: go_on}\n", "for_s: 5, at_s: 1.4, must: hold, reason: operator_stale}\n",
        "for_s: 5, at_s: 0.1, must: hold, reason: operator_stale}\n"}) {
    const TrialRecord record = judged(operatorLost(), kLost + must, [](KeptEvent&) {});
    EXPECT_FALSE(record.passed.value_or(true)) << must;
    EXPECT_THAT(record.verdict, HasSubstr("it did not")) << must;
  }
}

TEST(Trial, FailsWhereTheServoStoppedForAnotherCauseToo)
{
  const std::int64_t end = operatorLost().events.back().utime;
  const auto inTheEnd = [end](std::int16_t state) {
    return [end, state](KeptEvent& kept) {
      if (kept.channel != "SERVO_STATUS" || kept.utime < end - 200'000) return;
      servo_status_t status{};
      ASSERT_TRUE(kept.read(status));
      status.state = kept.utime < end - 100'000 ? servo_status_t::ASSIST : state;
      kept.write(status);
    };
  };
  // Both at 1.4 s: a second hold, once the fault has been over for long, and a fault while it lasts.
  const std::string brief = kLost + "at_s: 0.5, must: hold, for_s: 0.1}\n",
                    lasting = kLost + "at_s: 0.5, must: hold, for_s: 5}\n";
  const TrialRecord again = judged(operatorLost(), brief, inTheEnd(servo_status_t::HOLD));
  EXPECT_FALSE(again.passed.value_or(true)) << again.verdict;
  EXPECT_THAT(again.verdict, HasSubstr("at 1.4"));
  EXPECT_TRUE(judged(operatorLost(), lasting, inTheEnd(servo_status_t::HOLD)).passed.value_or(false));
  const TrialRecord worse = judged(operatorLost(), lasting, inTheEnd(servo_status_t::FAULT));
  EXPECT_FALSE(worse.passed.value_or(true)) << worse.verdict;
}

TEST(Trial, HoldsAPlaceBetterThanTheBareHandByFarAndNeverStops)
{
  ShortTrial held("task: hold\naid: hard\nsettling_s: 2\nduration_s: 3\n");
  const TrialRecord record = held.run().judge.record();
  EXPECT_TRUE(held.swept_plane) << "the aiming beam was not seen";
  EXPECT_LT(*record.score.rms_um, 20.0);
  EXPECT_LT(*record.score.p95_um, 35.0);
  EXPECT_EQ(record.score.hold_events + record.score.fault_events, 0);
  EXPECT_EQ(record.tracked, record.frames);
  EXPECT_EQ(record.frames, 90);
  EXPECT_LT(errorFigures(record.pose_errors_px).rms, 0.5);
  // Of a calibration sweep, and of a shaft that turns about its port.
  EXPECT_GT(record.fastest_tip, 3e-3);
  EXPECT_LT(record.fastest_tip, 30e-3);
  EXPECT_GT(record.worst_pivot, 0.0);
  EXPECT_LT(record.worst_pivot, 100e-6);

  ShortTrial bare("task: hold\naid: none\nsettling_s: 2\nduration_s: 3\n", 3, held.scene);
  EXPECT_GT(*bare.run().judge.record().score.rms_um, 100.0);
}

// Like the replay of a log: the servo alone, of whatever process, on what it heard in the trial.
TEST(LockStepServo, SendsTheSameBytesForTheSameMessagesInTheSameMilliseconds)
{
  const std::set<std::string> own{"MICRON_COMMAND", "LASER_COMMAND", "REGISTRATION", "SERVO_STATUS"};
  const ShortTrial& trial = traced();
  messaging::Link link("memq://", static_cast<std::int64_t>(trial.name.seed) + 1, std::nullopt);
  std::vector<std::string> said, expected;
  messaging::EventTap tap(link, [&](const messaging::TappedEvent& event) {
    if (own.count(std::string(event.channel)) == 0) return;
    said.push_back(std::string(event.channel) + std::string(reinterpret_cast<const char*>(event.data), event.size));
  });
  LockStepServo servo({trial.setting.servo, trial.setting.preparation, trial.setting.calibration}, std::nullopt, link);
  auto event = trial.events.begin();
  while (event != trial.events.end()) {
    const messaging::ReceiveTime now{event->utime, event->utime};
    for (; event != trial.events.end() && event->utime == now.utime; ++event) {
      if (own.count(event->channel) != 0) {
        expected.push_back(event->channel + event->bytes);
      } else {
        link.send(event->channel, reinterpret_cast<const std::uint8_t*>(event->bytes.data()), event->bytes.size());
      }
    }
    link.drain(now);
    servo.cycle(now);
    link.drain(now);
  }
  ASSERT_GT(expected.size(), 5000U);
  EXPECT_TRUE(said == expected);
}

}  // namespace
}  // namespace eyeslam::trials
