// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever goes wrong stops the servo within one cycle of passing its limit, and SERVO_STATUS says why.
#include <gtest/gtest.h>

#include <limits>

#include "eyeslam/servo/servo.h"
#include "support/servo_bench.h"

using namespace eyeslam;
using messaging::FixtureKind;
using messaging::MicronCommand;
using messaging::MicronMode;
using messaging::OperatorWish;
using messaging::WantedMode;
using retina::Reason;
using servo::State;
using support::ServoBench;

namespace {

constexpr std::int64_t kRival = 55;
const messaging::Key kOtherKey{3, 2, 1};

MicronCommand rivalCommand()
{
  MicronCommand command;
  command.mode = MicronMode::follow;
  command.goal.x() = 1e-3;
  return command;
}

/// In Assist, and whatever happens next.
class ServoFaults : public ::testing::Test {
 protected:
  void SetUp() override
  {
    bench.assist();
    ASSERT_EQ(bench.state(), State::assist);
  }

  /// The state and its reason, in the cycle and in the message that it sent.
  void expectNow(State state, Reason reason)
  {
    EXPECT_EQ(bench.state(), state);
    EXPECT_EQ(bench.reason(), reason) << retina::word(bench.reason());
    bench.link.drain(bench.now);
    ASSERT_FALSE(bench.said.empty());
    EXPECT_EQ(static_cast<State>(bench.said.back().state), state);
    EXPECT_EQ(bench.said.back().reason, reason);
  }
  /// Steps while nothing may happen, then one in which it must.
  void expectAfter(int milliseconds, State state, Reason reason)
  {
    for (int i = 0; i < milliseconds; ++i) {
      bench.step();
      ASSERT_EQ(bench.state(), State::assist) << i << ' ' << retina::word(bench.reason());
    }
    bench.step();
    expectNow(state, reason);
  }
  void expectNothing(int milliseconds)
  {
    for (int i = 0; i < milliseconds; ++i) {
      bench.step();
      ASSERT_EQ(bench.state(), State::assist) << i << ' ' << retina::word(bench.reason());
    }
  }

  ServoBench bench;
};

TEST_F(ServoFaults, ASilentManipulatorIsHoldAfter50Milliseconds)
{
  bench.controller_speaks = false;
  expectAfter(50, State::hold, Reason::state_stale);
  EXPECT_EQ(bench.servo->motion()->mode, MicronMode::cancel_tremor);  // no goal without a state
}

TEST_F(ServoFaults, AManipulatorThatDoesNotSeeItsTipIsHoldAfter50Milliseconds)
{
  bench.spoil_state = [](micron_state_t& state) { state.flags &= ~micron_state_t::POSE_MEASURED; };
  expectAfter(50, State::hold, Reason::state_stale);
}

TEST_F(ServoFaults, ASilentHumanIsHoldAfter200Milliseconds)
{
  while (bench.steps % 50 != 1) bench.step();  // he has just spoken
  bench.operator_speaks = false;
  expectAfter(200, State::hold, Reason::operator_stale);
}

TEST_F(ServoFaults, SilentVisionIsHoldWhenItsLastFrameIs250MillisecondsOld)
{
  while (bench.steps % 33 != 0) bench.step();  // a frame that is 15 ms old has come
  bench.vision_speaks = false;
  expectAfter(250 - 15, State::hold, Reason::pose_stale);
}

TEST_F(ServoFaults, VisionThatSeesNothingSaysWhyItself)
{
  for (const Reason why : {Reason::blackout, Reason::ambiguous}) {
    ServoBench bench_of_reason;
    bench_of_reason.assist();
    bench_of_reason.spoil_pose = [why](retina_pose_t& pose) {
      pose.tracked = 0;
      pose.reason = static_cast<std::int16_t>(why);
      pose.velocity_x_px = pose.velocity_y_px = pose.velocity_theta = 0.0;
    };
    EXPECT_GE(bench_of_reason.runUntil(State::hold, 300), 200);
    EXPECT_EQ(bench_of_reason.reason(), why);
  }
}

TEST_F(ServoFaults, AStateThatIsNoNumberIsAFault)
{
  bench.spoil_state = [](micron_state_t& state) { state.tip_position[1] = std::numeric_limits<double>::quiet_NaN(); };
  bench.step();
  expectNow(State::fault, Reason::state_not_finite);
}

TEST_F(ServoFaults, AManipulatorWithoutPowerIsAFault)
{
  bench.spoil_state = [](micron_state_t& state) { state.flags &= ~micron_state_t::POWERED; };
  bench.step();
  expectNow(State::fault, Reason::unpowered);
}

TEST_F(ServoFaults, AnotherControllerIsAFault)
{
  messaging::MicronState state;
  state.powered = state.pose_measured = true;
  bench.put("MICRON_STATE", bench.foreign<micron_state_t>(state, kRival, 0));
  bench.step();
  expectNow(State::fault, Reason::controller_restarted);
}

TEST_F(ServoFaults, AClockThatStepsIsAFault)
{
  bench.spoil_state = [](micron_state_t& state) { state.utime += 10; };
  bench.step();
  bench.controller_speaks = false;
  // The same sender goes on, half a second ahead.
  messaging::MicronState state;
  state.powered = state.pose_measured = true;
  micron_state_t message{};
  messaging::write(state, message);
  message.utime = message.utime_sent = bench.now.utime + 500'000;
  message.seq = 1'000'000;
  message.session = bench.link.session();
  bench.put("MICRON_STATE", support::encodedMessage(message, ServoBench::kKey));
  // How far a clock may be ahead is judged by a message or two (sender_clock.h).
  EXPECT_GE(bench.runUntil(State::fault, 3), 0);
  expectNow(State::fault, Reason::clock_stepped);
}

TEST_F(ServoFaults, AnotherServoIsAFault)
{
  bench.put("MICRON_COMMAND", bench.foreign<micron_command_t>(rivalCommand(), kRival, 0));
  bench.step();
  expectNow(State::fault, Reason::rival_servo);
}

TEST_F(ServoFaults, AServoThatFiresIsARivalToo)
{
  bench.put("LASER_COMMAND", bench.foreign<laser_command_t>(messaging::LaserCommand{}, kRival, 0));
  bench.step();
  expectNow(State::fault, Reason::rival_servo);
}

TEST(Servo, AServoThatSpokeFirstIsARivalToo)
{
  ServoBench bench;
  bench.askMode(WantedMode::standby);
  bench.step();
  bench.put("MICRON_COMMAND", bench.foreign<micron_command_t>(rivalCommand(), kRival, 0));
  bench.step();
  EXPECT_EQ(bench.state(), State::fault);
  EXPECT_EQ(bench.reason(), Reason::rival_servo);
  // It goes away; after re-arming one's own commands are no rival's.
  bench.askMode(WantedMode::ready);
  bench.rearm();
  bench.run(100);
  EXPECT_EQ(bench.state(), State::ready);
}

struct Attack {
  const char* name;
  Reason reason;
  void (*send)(ServoBench& bench, int i);
};

void PrintTo(const Attack& attack, std::ostream* out) { *out << attack.name; }

class ServoAttacked : public ServoFaults, public ::testing::WithParamInterface<Attack> {};

TEST_P(ServoAttacked, HoldsAtTheFourthRefusedMessageOfASecondAndNotBefore)
{
  for (int i = 0; i < 3; ++i) {
    GetParam().send(bench, i);
    expectNothing(100);
  }
  expectNothing(900);  // now the first two are forgotten
  for (int i = 3; i < 5; ++i) {
    GetParam().send(bench, i);
    expectNothing(1);
  }
  GetParam().send(bench, 5);
  GetParam().send(bench, 6);
  bench.step();
  expectNow(State::hold, GetParam().reason);
}

constexpr Attack kAttacks[] = {
    {"forged", Reason::unauthenticated,
     [](ServoBench& bench, int i) {
       bench.put("OPERATOR", bench.foreign<operator_t>(OperatorWish{}, 99, 1000 + i, kOtherKey));
     }},
    {"forged_command", Reason::unauthenticated,
     [](ServoBench& bench, int i) {
       bench.put("MICRON_COMMAND", bench.foreign<micron_command_t>(rivalCommand(), 99, 1'000'000 + i, kOtherKey));
     }},
    {"replayed", Reason::replayed,
     [](ServoBench& bench, int) { bench.put("OPERATOR", bench.foreign<operator_t>(OperatorWish{}, 99, 0)); }},
    {"another_session", Reason::wrong_session,
     [](ServoBench& bench, int i) { bench.put("OPERATOR", bench.foreign<operator_t>(OperatorWish{}, kRival, i)); }},
    {"another_type", Reason::wrong_type,
     [](ServoBench& bench, int i) {
       bench.put("RETINA_POSE", bench.foreign<micron_command_t>(rivalCommand(), 99, i));
     }},
    {"cut", Reason::wrong_length,
     [](ServoBench& bench, int i) {
       support::Bytes bytes = bench.foreign<servo_status_t>(messaging::ServoStatus{}, 99, i);
       bytes.resize(4);
       bench.put("TOOL_TIP", bytes);
     }},
};
INSTANTIATE_TEST_SUITE_P(Every, ServoAttacked, ::testing::ValuesIn(kAttacks),
                         [](const auto& each) { return std::string(each.param.name); });

TEST_F(ServoFaults, WhatTheControllerRefusedCountsToo)
{
  std::int64_t refused = 100;  // its past
  bench.spoil_state = [&refused](micron_state_t& state) {
    state.commands_refused[messaging::refusalIndex(Reason::replayed)] = refused;
  };
  ServoBench another;
  another.spoil_state = bench.spoil_state;
  another.assist();
  ASSERT_EQ(another.state(), State::assist);  // what it refused before is its past
  refused += 3;
  another.run(2);
  ASSERT_EQ(another.state(), State::assist);
  refused += 1;
  another.step();
  EXPECT_EQ(another.state(), State::hold);
  EXPECT_EQ(another.reason(), Reason::replayed);
}

TEST_F(ServoFaults, CommandsOfWhichNoneIsObeyedForAWholeLifeAreHold)
{
  bench.spoil_state = [](micron_state_t& state) { state.reason = static_cast<std::int16_t>(Reason::expired); };
  expectAfter(50, State::hold, Reason::expired);
}

TEST_F(ServoFaults, APoseThatJumpsFartherThanAnyEyeIsHold)
{
  double jump_px = 250.0;  // 1.25 mm: a saccade
  bench.spoil_pose = [&jump_px](retina_pose_t& pose) { pose.x_px += jump_px; };
  expectNothing(400);
  jump_px += 310.0;  // 1.55 mm
  while (bench.steps % 33 != 32) bench.step();
  ASSERT_EQ(bench.state(), State::assist);
  bench.step();
  expectNow(State::hold, Reason::pose_jumped);
}

TEST_F(ServoFaults, APoseThatTurnsTheTipAwayIsHoldToo)
{
  bench.assist(ServoBench::mapPoint(1.5e-3, 0.0));
  bench.hand = [](double) { return Eigen::Vector3d(1.5e-3, 0.0, -1e-3); };
  bench.run(500);
  bench.spoil_pose = [](retina_pose_t& pose) { pose.theta = 3.0; };
  while (bench.steps % 33 != 32) bench.step();
  bench.step();
  expectNow(State::hold, Reason::pose_jumped);
}

TEST_F(ServoFaults, AFixtureOfAnotherMapIsHold)
{
  bench.spoil_pose = [](retina_pose_t& pose) { pose.map_id = 8; };
  while (bench.steps % 33 != 32) bench.step();
  bench.step();
  expectNow(State::hold, Reason::map_changed);
}

TEST_F(ServoFaults, AnotherMapWithAnotherOriginIsNoJump)
{
  bench.ask([](OperatorWish& w) {
    w.fixture = {};
    w.fixture.kind = FixtureKind::filter;
  });
  bench.run(100);
  bench.spoil_pose = [](retina_pose_t& pose) {
    pose.map_id = 8;
    pose.x_px += 600.0;  // 3 mm
  };
  expectNothing(500);
}

TEST_F(ServoFaults, AVesselThatNobodyKnowsIsHold)
{
  bench.ask([](OperatorWish& w) {
    w.fixture = {};
    w.fixture.kind = FixtureKind::vessel;
    w.fixture.vessel = 3;
  });
  bench.step();
  expectNow(State::hold, Reason::no_vessel);
}

TEST_F(ServoFaults, AHumanWhoStopsStops)
{
  bench.ask([](OperatorWish& w) { w.stop = true; });
  bench.step();
  expectNow(State::hold, Reason::stopped);
}

TEST_F(ServoFaults, OnlyAHumanWhoRearmsLeavesHold)
{
  bench.ask([](OperatorWish& w) { w.stop = true; });
  bench.run(10);
  bench.ask([](OperatorWish& w) { w.stop = false; });
  bench.run(500);
  expectNow(State::hold, Reason::stopped);
  bench.rearm();
  bench.step();
  EXPECT_EQ(bench.state(), State::ready);
  bench.step();
  EXPECT_EQ(bench.state(), State::assist);
}

TEST_F(ServoFaults, RearmingHearsTheControllerThatTookOver)
{
  bench.controller_speaks = false;
  messaging::MicronState state;
  state.powered = state.pose_measured = true;
  std::int64_t seq = 0;
  const auto speak = [&] {
    micron_state_t message{};
    messaging::write(state, message);
    bench.put("MICRON_STATE", bench.foreign<micron_state_t>(state, kRival, seq++));
    bench.step();
  };
  for (int i = 0; i < 100; ++i) speak();
  expectNow(State::fault, Reason::controller_restarted);
  bench.rearm();
  for (int i = 0; i < 100; ++i) speak();
  EXPECT_EQ(bench.state(), State::assist) << retina::word(bench.reason());
}

TEST_F(ServoFaults, AnotherConsoleMaySpeakWhenTheFirstIsSilentButItsFirstWordRearmsNothing)
{
  bench.operator_speaks = false;
  std::int64_t seq = 0;
  OperatorWish wish = bench.wish;
  wish.rearmed = 40;
  const auto speak = [&] { bench.put("OPERATOR", bench.foreign<operator_t>(wish, kRival, seq++)); };
  speak();
  bench.step();
  EXPECT_EQ(bench.servo->status().messages_refused[messaging::refusalIndex(Reason::wrong_session)], 1);
  bench.run(300);
  expectNow(State::hold, Reason::operator_stale);
  speak();
  bench.step();
  speak();
  bench.run(10);
  EXPECT_EQ(bench.state(), State::hold);
  ++wish.rearmed;
  speak();
  bench.step();
  EXPECT_EQ(bench.state(), State::ready);
}

TEST_F(ServoFaults, NoLaserIsLitInAssist)
{
  int lit = 0;
  messaging::Subscription<laser_command_t> lasers(
      bench.link, [&lit](const messaging::LaserCommand&, const messaging::MessageHeader&) { ++lit; });
  bench.run(200);
  EXPECT_EQ(lit, 0);
}

}  // namespace
