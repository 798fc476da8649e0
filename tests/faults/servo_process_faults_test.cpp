// SPDX-License-Identifier: GPL-3.0-or-later
// What is left of a servo that is gone, and of two that are there; EYESLAM_SERVO is the program.
#include <csignal>
#include <map>

#include "support/live_bench.h"
#include "support/live_fault.h"

namespace eyeslam {
namespace {

using messaging::ServoState;
using messaging::WantedMode;
using retina::Reason;

class ServoProcess : public support::LiveFaultOn<support::LiveBench> {
 protected:
  /// A pulse is under way.
  void fire()
  {
    bench.foot_switch = true;
    const auto emits = [this] { return !bench.record.lasers.empty() && bench.record.lasers.last().value.emitting; };
    for (int i = 0; i < 200 && !emits(); ++i) bench.run(30);
    ASSERT_TRUE(emits()) << describe(bench.record.statuses.last());
  }
  /// The controller goes its own way, and says why, when the last command lapses.
  void expectTheControllerTakesOver()
  {
    bench.run(500);
    const std::int64_t last = bench.record.motions.last().header.utime_sent;
    constexpr std::int64_t kExpiry_us = 50'000, kReport_us = 2'000;
    const auto states = bench.record.states.since(last + kExpiry_us + kReport_us);
    ASSERT_GT(states.size(), 100U);
    for (const auto& state : states) {
      ASSERT_FALSE(state.value.follows_command) << 1e-3 * static_cast<double>(state.header.utime_sent - last) << " ms";
      ASSERT_TRUE(state.value.cancels_tremor);
      ASSERT_EQ(state.value.reason, Reason::expired);
    }
    expectLaserOff(last + 1);
    expectCalmTip();
  }
};

TEST_F(ServoProcess, WithoutAFaultItGoesOn)
{
  ASSERT_NO_FATAL_FAILURE(begin(WantedMode::laser));
  settle(2000);
  bench.ask([](messaging::OperatorWish& wish) { wish.mode = WantedMode::ready; });
  EXPECT_TRUE(bench.runUntil([this] { return bench.state() == ServoState::ready; }, 1000));
  bench.askAssist();
  wanted = ServoState::assist;
  EXPECT_TRUE(bench.runUntil([this] { return bench.state() == ServoState::assist; }, 1000));
  settle(1500);
  EXPECT_EQ(servo->end(SIGTERM), 0) << servo->text();
}

TEST_F(ServoProcess, KilledWhileItGuidesLeavesTheTipToTheController)
{
  ASSERT_NO_FATAL_FAILURE(begin(WantedMode::assist));
  mark();
  servo->send(SIGKILL);
  expectTheControllerTakesOver();
}

TEST_F(ServoProcess, KilledInAPulseLeavesTheLaserDarkWithin5Milliseconds)
{
  ASSERT_NO_FATAL_FAILURE(begin(WantedMode::laser));
  ASSERT_NO_FATAL_FAILURE(fire());
  mark();
  servo->send(SIGKILL);
  expectTheControllerTakesOver();
  EXPECT_EQ(bench.record.lasers.last().value.reason, Reason::command_lapsed);
}

TEST_F(ServoProcess, AfterAKilledOneAnotherIsHeardOnlyWhenTheDevicesAreRestarted)
{
  ASSERT_NO_FATAL_FAILURE(begin(WantedMode::assist));
  mark();
  servo->send(SIGKILL);
  bench.run(200);
  servo = bench.startServo("another");
  bench.run(1500);
  EXPECT_FALSE(bench.record.states.last().value.follows_command) << "the controller keeps to the first it heard";
  EXPECT_EQ(bench.state(), ServoState::hold);
  EXPECT_EQ(bench.record.statuses.last().value.reason, Reason::wrong_session);
  bench.hardware().inject(simulation::HardwareFault::restart);
  bench.run(100);
  bench.record.acceptNewSessions();
  EXPECT_EQ(bench.state(), ServoState::fault);
  bench.rearm();
  EXPECT_TRUE(bench.runUntil([this] { return bench.state() == wanted; }, 1000));
  bench.run(300);
  EXPECT_TRUE(bench.record.states.last().value.follows_command) << describe(bench.record.statuses.last());
}

TEST_F(ServoProcess, APulseEndsWhenTheServoStops)
{
  ASSERT_NO_FATAL_FAILURE(begin(WantedMode::laser));
  ASSERT_NO_FATAL_FAILURE(fire());
  mark();
  bench.hardware().inject(simulation::HardwareFault::tip_not_finite);
  has_states = false;
  expectStop(ServoState::fault, Reason::state_not_finite);
}

TEST_F(ServoProcess, OneThatComesLaterIsInFaultAndTheFirstGoesOn)
{
  ASSERT_NO_FATAL_FAILURE(begin(WantedMode::laser));
  const std::int64_t first = bench.record.motions.last().header.session;
  mark();
  const auto another = bench.startServo("another");
  const auto isOther = [&](const Status& status) { return status.header.session != first; };
  bench.runUntil([&] { return isOther(bench.record.statuses.last()); }, 5000);
  bench.run(500);
  int others = 0;
  for (const Status& status : bench.record.statuses.since(fault_utime)) {
    if (!isOther(status)) {
      EXPECT_EQ(status.value.state, wanted) << describe(status);
    } else if (++others > 1) {
      EXPECT_EQ(status.value.state, ServoState::fault) << describe(status);
      EXPECT_EQ(status.value.reason, Reason::rival_servo) << describe(status);
    }
  }
  EXPECT_GT(others, 5);
  EXPECT_EQ(bench.record.motions.last().header.session, first);
}

TEST_F(ServoProcess, ARivalThatCommandsIsAFaultAtOnce)
{
  ASSERT_NO_FATAL_FAILURE(begin(WantedMode::laser));
  ASSERT_NO_FATAL_FAILURE(fire());
  mark();
  messaging::MicronCommand command;
  command.mode = messaging::MicronMode::follow;
  command.goal.x() = 1e-3;
  bench.put("MICRON_COMMAND", bench.message<micron_command_t>(command, 55, 0));
  const auto stop = expectStop(ServoState::fault, Reason::rival_servo);
  ASSERT_TRUE(stop);
  EXPECT_LE(1e-6 * static_cast<double>(stop->header.utime_sent - fault_utime), 10e-3 + cycleOf(*stop));
  expectOnlyRearmingLeads(wanted);
}

TEST_F(ServoProcess, OfTwoThatBeginTogetherOneAtMostGoesOn)
{
  bench.ask([](messaging::OperatorWish& wish) { wish.mode = WantedMode::standby; });
  servo = bench.startServo();
  const auto another = bench.startServo("another");
  std::map<std::int64_t, Status> newest;
  const auto look = [&] {
    for (const Status& status : bench.record.statuses.all()) newest.insert_or_assign(status.header.session, status);
    return newest.size() == 2;
  };
  ASSERT_TRUE(bench.runUntil(look, 10'000));
  bench.run(300);
  mark();
  bench.askLaser();
  bench.run(500);
  look();
  int faults = 0;
  for (const auto& [session, status] : newest) {
    if (status.value.state != ServoState::fault) continue;
    ++faults;
    EXPECT_EQ(status.value.reason, Reason::rival_servo) << describe(status);
  }
  EXPECT_GE(faults, 1) << "who has heard the other stops, before he has commanded himself where he was the later one";
  EXPECT_EQ(bench.record.motions.last().header.session, bench.record.states.last().value.command_session);
  expectCalmTip();
}

}  // namespace
}  // namespace eyeslam
