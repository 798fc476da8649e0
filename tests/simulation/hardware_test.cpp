// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/hardware.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "eyeslam/messaging/authentication.h"
#include "support/encoded_message.h"

namespace eyeslam::simulation {
namespace {

using messaging::LaserAction;
using messaging::LaserCommand;
using messaging::Link;
using messaging::MicronCommand;
using messaging::MicronMode;
using messaging::MicronState;
using messaging::Publisher;
using messaging::Subscription;
using retina::Reason;

constexpr std::int64_t kStart = 1'700'000'000'000'000;
const messaging::Key kKey = {1, 2, 3};
const messaging::Key kOtherKey = {3, 2, 1};

HardwareOptions inSitu()
{
  HardwareOptions options;
  options.camera.width = 400;
  options.camera.height = 304;
  return options;
}

/// Hardware on a link, one who listens and one who commands it.
class Bench {
 public:
  explicit Bench(std::uint64_t seed = 1, const HardwareOptions& options = inSitu())
      : place(0.5 * options.camera.width * umPerPx(options.camera, seed) * 1e-6,
              0.5 * options.camera.height * umPerPx(options.camera, seed) * 1e-6, -4e-4),
        hardware(
            options, [this](double) { return task; }, link, seed)
  {
    task.target.position = place;
    task.support = HandTremor::Support::fixture;
    task.switches.foot_switch = true;
  }

  void step(int periods = 1)
  {
    for (int i = 0; i < periods; ++i) {
      now += 1000;
      link.drain({now, now});
      hardware.step({now, now});
      if (const auto due = hardware.frameDue()) frames.push_back(*due);
      link.drain({now, now});
      if (!each) continue;
      each();
      link.drain({now, now});
    }
  }
  /// The tip stays at the place of the retina: what a perfect servo commands.
  void follow()
  {
    MicronCommand command;
    command.mode = MicronMode::follow;
    command.goal = hardware.manipulatorTWorld() * hardware.truth().eye.world_T_retina.toWorld(place);
    motions.publish(command, now, now);
  }
  void fire(std::int64_t pulse)
  {
    LaserCommand command;
    command.action = LaserAction::fire;
    command.pulse = pulse;
    command.target = 7;
    command.duration = 0.02;
    command.power = 0.2;
    pulses.publish(command, now, now);
  }

  std::int64_t now = kStart;
  SurgeonTask task;
  Link link{"memq://", 99, kKey};
  Subscription<micron_state_t> states{link};
  Subscription<laser_state_t> laser_states{link};
  Publisher<micron_command_t> motions{link};
  Publisher<laser_command_t> pulses{link};
  Eigen::Vector3d place;
  Hardware hardware;
  std::vector<FrameDue> frames;
  std::function<void()> each;
};

TEST(Hardware, SpeaksItsStateEachMillisecondAndTheLasersEachTenth)
{
  Bench bench;
  bench.step(1000);
  EXPECT_EQ(bench.states.accepted(), 1000);
  EXPECT_EQ(bench.states.lost(), 0);
  EXPECT_EQ(bench.laser_states.accepted(), 100);
  EXPECT_EQ(bench.states.header().utime_sent, bench.now);
  EXPECT_EQ(bench.states.header().utime, bench.now - 1000);  // measured a millisecond ago
}

TEST(Hardware, TellsTheLasersChangesAtOnce)
{
  Bench bench;
  bench.step(3);
  bench.task.switches.foot_switch = false;
  bench.step();
  EXPECT_FALSE(bench.laser_states.latest()->foot_switch);
}

TEST(Hardware, ItsStateIsTheTruthWithinItsNoise)
{
  Bench bench;
  bench.each = [&] { bench.follow(); };
  bench.step(2000);
  const HardwareTruth before = bench.hardware.truth();
  bench.step();  // the state of now is as old as the truth of before
  const MicronState& state = *bench.states.latest();
  const Eigen::Isometry3d& frame = bench.hardware.manipulatorTWorld();
  EXPECT_LT((state.null.position - frame * before.hand.null).norm(), 15e-6);
  EXPECT_LT((state.tip.position - frame * before.tip).norm(), 40e-6);  // bending is not measured
  EXPECT_GT((frame.linear() - Eigen::Matrix3d::Identity()).norm(), 0.5);
}

TEST(Hardware, APerfectServoHoldsAPlaceOfTheMovingRetina)
{
  Bench bench;
  double held = 0.0, loose = 0.0;
  bench.each = [&] {
    bench.follow();
    held += bench.hardware.truth().t_s > 1.0 ? (bench.hardware.truth().tipRetina() - bench.place).squaredNorm() : 0.0;
  };
  bench.step(5000);
  Bench free;
  free.each = [&] {
    loose += free.hardware.truth().t_s > 1.0 ? (free.hardware.truth().nullRetina() - free.place).squaredNorm() : 0.0;
  };
  free.step(5000);
  EXPECT_LT(std::sqrt(held / 4000.0), 80e-6);  // no prediction of hand and retina here
  EXPECT_GT(std::sqrt(loose / 4000.0), 120e-6);
}

TEST(Hardware, AServoThatFallsSilentIsFollowedForFiftyMilliseconds)
{
  Bench bench;
  bench.each = [&] { bench.follow(); };
  bench.step(500);
  bench.each = {};
  bench.step(50);
  EXPECT_TRUE(bench.states.latest()->follows_command);
  bench.step(1);
  EXPECT_EQ(bench.states.latest()->reason, Reason::expired);
  EXPECT_TRUE(bench.states.latest()->cancels_tremor);
}

TEST(Hardware, CountsAndRefusesForgedReplayedAndLateCommands)
{
  Bench bench;
  bench.step(10);
  micron_command_t message{};
  MicronCommand value;
  value.mode = MicronMode::follow;
  ASSERT_EQ(messaging::write(value, message), Reason::none);
  message.session = 99;
  const auto put = [&](std::int64_t seq, std::int64_t sent, const messaging::Key& key) {
    message.seq = seq;
    message.utime = message.utime_sent = sent;
    const support::Bytes bytes = support::encodedMessage(message, key);
    bench.link.send("MICRON_COMMAND", bytes.data(), bytes.size());
    bench.step();
  };
  const auto refused = [&](Reason why) {
    return bench.states.latest()->commands_refused[messaging::refusalIndex(why)];
  };
  put(5, bench.now, kOtherKey);
  EXPECT_EQ(refused(Reason::unauthenticated), 1);
  EXPECT_EQ(bench.states.latest()->command_seq, -1);
  put(6, bench.now, kKey);
  EXPECT_EQ(bench.states.latest()->command_seq, 6);
  EXPECT_EQ(bench.states.latest()->command_session, 99);
  put(6, bench.now, kKey);
  EXPECT_EQ(refused(Reason::replayed), 1);
  bench.step(60);
  put(7, bench.now - 60'000, kKey);
  EXPECT_EQ(refused(Reason::expired), 1);
  put(4, bench.now, kKey);
  EXPECT_EQ(refused(Reason::out_of_order), 1);
  EXPECT_EQ(bench.states.latest()->command_seq, 6);
}

TEST(Hardware, APulseFallsWhereTheBeamMeetsTheMovingRetina)
{
  Bench bench;
  bench.each = [&] {
    bench.follow();
    if (bench.hardware.truth().t_s > 1.0) bench.fire(1);
  };
  bench.step(1003);
  ASSERT_EQ(bench.hardware.pulses().size(), 1U);
  EXPECT_TRUE(bench.laser_states.latest()->emitting);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double most_height = 0.0;
  int count = 0;
  // Its own interval: from the step in which it begins to the one in which it has ended.
  Bench again;
  again.each = [&] {
    again.follow();
    if (again.hardware.truth().t_s > 1.0) again.fire(1);
    const bool begun = !again.hardware.pulses().empty();
    if (!begun || count > 20) return;
    ++count;
    const HardwareTruth& truth = again.hardware.truth();
    sum += truth.spotRetina();
    most_height = std::max(most_height, std::abs(truth.spotRetina().z()));
    // In the line of the shaft, by the height of the tip x tan of its tilt.
    const double way = (truth.spot - truth.tip).norm();
    EXPECT_LT((truth.spot - truth.tip + way * truth.shaft).norm(), 1e-12);
  };
  again.step(1100);
  const PulseTruth& pulse = again.hardware.pulses().front();
  EXPECT_EQ(pulse.target, 7);
  EXPECT_NEAR(pulse.duration, 0.02, 1e-9);
  EXPECT_LT((pulse.spot_retina - sum / count).norm(), 1e-9);
  EXPECT_LT(most_height, 1e-12);
}

TEST(Hardware, GivesFramesInTimeAndInTheirOrder)
{
  HardwareOptions options = inSitu();
  options.camera.fps = 120.0;
  options.camera.exposure_ms = 4.0;
  Bench bench(1, options);
  bench.step(1000);
  ASSERT_EQ(bench.frames.size(), 120U);
  for (std::size_t k = 0; k < bench.frames.size(); ++k) {
    const FrameDue& due = bench.frames[k];
    EXPECT_EQ(due.frame, static_cast<int>(k));
    EXPECT_NEAR(due.t_s, static_cast<double>(k) / 120.0, 1e-12);
    EXPECT_NEAR(1e-6 * static_cast<double>(due.utime - (kStart + 1000)), due.t_s, 1e-6);
  }
}

/// Everything that a run says, as bytes, and what its frames show.
struct Record {
  support::Bytes said;
  std::vector<double> shown;

  bool operator==(const Record& other) const { return said == other.said && shown == other.shown; }
};

Record record(std::uint64_t seed)
{
  Bench bench(seed);
  Record kept;
  bench.each = [&] {
    bench.follow();
    bench.fire(1 + bench.now / 100'000 % 1000);
    micron_state_t message{};
    EXPECT_EQ(messaging::write(*bench.states.latest(), message), Reason::none);
    const support::Bytes encoded = support::encodedMessage(message);
    kept.said.insert(kept.said.end(), encoded.begin(), encoded.end());
  };
  bench.step(1500);
  for (const FrameDue& due : bench.frames) {
    const retina::Pose2 pose = due.view.at(due.t_s);
    kept.shown.insert(kept.shown.end(), {pose.x, pose.y, pose.theta, due.tool.tool.tip.x, due.tool.spot.y,
                                         due.tool.flash, static_cast<double>(due.burns_map.size())});
  }
  return kept;
}

TEST(Hardware, IsTheSameToTheByteForASeed)
{
  const Record once = record(3);
  EXPECT_TRUE(once == record(3));
  EXPECT_FALSE(once == record(4));
}

TEST(HardwareFault, KnowsItsNames)
{
  for (std::size_t i = 0; i < kHardwareFaults; ++i) {
    EXPECT_EQ(hardwareFault(hardwareFaultNames()[i]), static_cast<HardwareFault>(i));
  }
  EXPECT_THROW(hardwareFault("fire"), std::invalid_argument);
}

TEST(HardwareFault, StatesStopAndComeBack)
{
  Bench bench;
  bench.step(20);
  bench.hardware.inject(HardwareFault::states_stop);
  bench.step(100);
  EXPECT_EQ(bench.states.silence(bench.now), 100'000);
  bench.hardware.mend(HardwareFault::states_stop);
  bench.step();
  EXPECT_EQ(bench.states.silence(bench.now), 0);
}

TEST(HardwareFault, ATipThatIsNoNumberIsSent)
{
  Bench bench;
  bench.step(20);
  bench.hardware.inject(HardwareFault::tip_not_finite);
  bench.step(10);
  EXPECT_EQ(bench.states.refused(Reason::not_finite), 10);
}

TEST(HardwareFault, ARestartedControllerIsAnotherSession)
{
  Bench bench;
  bench.each = [&] { bench.follow(); };
  bench.step(200);
  bench.hardware.inject(HardwareFault::restart);
  bench.step(10);
  EXPECT_EQ(bench.states.refused(Reason::wrong_session), 10);
  bench.states.acceptNewSession();
  bench.step();
  EXPECT_EQ(bench.states.header().session, 100);
  EXPECT_TRUE(bench.states.latest()->follows_command);
}

TEST(HardwareFault, ASteppedClockIsNoticed)
{
  Bench bench;
  bench.step(200);
  bench.hardware.inject(HardwareFault::clock_step);
  bench.step(1);
  EXPECT_EQ(bench.states.fault(), Reason::clock_stepped);
}

TEST(HardwareFault, WithoutPowerNoCommandIsFollowed)
{
  Bench bench;
  bench.each = [&] { bench.follow(); };
  bench.step(200);
  bench.hardware.inject(HardwareFault::power_off);
  bench.step(1);
  EXPECT_FALSE(bench.states.latest()->powered);
  EXPECT_EQ(bench.states.latest()->reason, Reason::not_powered);
}

TEST(HardwareFault, ASilentLaserIsSilent)
{
  Bench bench;
  bench.hardware.inject(HardwareFault::laser_silent);
  bench.step(50);
  EXPECT_EQ(bench.laser_states.accepted(), 0);
}

TEST(HardwareFault, AnOpenInterlockEndsAPulse)
{
  Bench bench;
  bench.each = [&] { bench.fire(1); };
  bench.step(10);
  EXPECT_TRUE(bench.laser_states.latest()->emitting);
  bench.hardware.inject(HardwareFault::interlock_open);
  bench.step(1);
  EXPECT_FALSE(bench.laser_states.latest()->emitting);
  EXPECT_EQ(bench.laser_states.latest()->reason, Reason::interlock_open);
  EXPECT_LT(bench.hardware.pulses().front().duration, 0.012);
}

TEST(HardwareFault, ACameraStopsOrFreezes)
{
  Bench bench;
  bench.hardware.inject(HardwareFault::camera_freezes);
  bench.step(100);
  ASSERT_EQ(bench.frames.size(), 3U);
  EXPECT_TRUE(bench.frames.back().repeats);
  bench.hardware.inject(HardwareFault::camera_stops);
  bench.step(200);
  EXPECT_EQ(bench.frames.size(), 3U);
}

}  // namespace
}  // namespace eyeslam::simulation
