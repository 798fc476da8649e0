// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/servo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/servo_bench.h"

using namespace eyeslam;
using messaging::FixtureKind;
using messaging::MicronMode;
using messaging::OperatorWish;
using messaging::WantedMode;
using retina::Reason;
using servo::State;
using support::ServoBench;

namespace {

constexpr double kRamp_ms = 150.0;

TEST(Servo, CommandsNothingBeforeAHumanWantsIt)
{
  ServoBench bench;
  for (int i = 0; i < 500; ++i) {
    bench.step();
    ASSERT_FALSE(bench.servo->motion());
  }
  EXPECT_EQ(bench.state(), State::standby);
}

TEST(Servo, GoesWhereTheHumanWants)
{
  ServoBench bench;
  bench.askMode(WantedMode::ready);
  EXPECT_LE(bench.runUntil(State::ready, 2), 2);
  bench.servo->adopt(ServoBench::calibration(), ServoBench::kStart_us);
  bench.run(100);
  bench.ask([](OperatorWish& w) {
    w.mode = WantedMode::assist;
    w.fixture.kind = FixtureKind::filter;
  });
  bench.step();
  EXPECT_EQ(bench.state(), State::assist);
  EXPECT_EQ(bench.servo->motion()->mode, MicronMode::follow);
  bench.askMode(WantedMode::ready);
  bench.step();
  EXPECT_EQ(bench.state(), State::ready);
  bench.askMode(WantedMode::standby);
  bench.step();
  EXPECT_EQ(bench.state(), State::standby);
}

TEST(Servo, SaysWhyItIsNotWhereTheHumanWants)
{
  ServoBench bench;
  bench.vision_speaks = false;
  bench.ask([](OperatorWish& w) {
    w.mode = WantedMode::assist;
    w.fixture.kind = FixtureKind::filter;
  });
  bench.run(100);
  EXPECT_EQ(bench.state(), State::ready);
  EXPECT_EQ(bench.reason(), Reason::not_registered);
  bench.servo->adopt(ServoBench::calibration(), ServoBench::kStart_us);
  bench.step();
  EXPECT_EQ(bench.reason(), Reason::no_pose);
  bench.vision_speaks = true;
  bench.run(100);
  EXPECT_EQ(bench.state(), State::assist);
  EXPECT_EQ(bench.reason(), Reason::none);
}

// Poses that came while nothing could be made of them: the end of a calibration is no reason to hold.
TEST(Servo, GoesOnAtOnceWhenItIsRegisteredAndPosesHaveCome)
{
  ServoBench bench;
  bench.ask([](OperatorWish& w) {
    w.mode = WantedMode::assist;
    w.fixture.kind = FixtureKind::filter;
  });
  bench.run(100);
  bench.servo->adopt(ServoBench::calibration(), ServoBench::kStart_us);
  bench.step();
  EXPECT_EQ(bench.state(), State::assist);
}

TEST(Servo, HoldsThePlaceOfTheRetinaThatTheHumanNamed)
{
  ServoBench bench;
  bench.hand = [](double t) {
    return Eigen::Vector3d(200e-6 * std::sin(1.5 * t), 50e-6 * std::sin(57.0 * t), -1e-3 + 60e-6 * std::sin(60.0 * t));
  };
  bench.retina = [](double t) { return Eigen::Vector2d(300e-6 * std::sin(1.2 * t), 100e-6 * std::sin(2.0 * t)); };
  bench.assist(ServoBench::mapPoint(300e-6, -200e-6));
  bench.run(2000);
  ASSERT_EQ(bench.state(), State::assist) << static_cast<int>(bench.reason());
  for (int i = 0; i < 1000; ++i) {
    bench.step();
    const Eigen::Vector2d wanted = bench.retinaAt(bench.time()) + Eigen::Vector2d(300e-6, -200e-6);
    // Tremor of 50 um is predicted over the plant's 4.8 ms, which this manipulator does not need.
    ASSERT_LT((bench.tip.head<2>() - wanted).norm(), 40e-6) << i;
  }
}

TEST(Servo, InReadyTheTipFollowsTheHandWithoutItsTremor)
{
  ServoBench bench;
  bench.hand = [](double t) { return Eigen::Vector3d(100e-6 * std::sin(60.0 * t), 0.0, -1e-3); };
  bench.askMode(WantedMode::ready);
  bench.run(2000);
  double largest = 0.0;
  for (int i = 0; i < 500; ++i) {
    bench.step();
    largest = std::max(largest, std::abs(bench.tip.x()));
  }
  EXPECT_LT(largest, 30e-6);
}

TEST(Servo, GoalsGoToWhoeverSubtractsTheNull)
{
  for (const char* at : {"servo", "controller"}) {
    servo::ServoOptions options;
    options.cycle.null_at = at;
    ServoBench bench(options);
    bench.assist(ServoBench::mapPoint(200e-6, 0.0));
    const auto& motion = *bench.servo->motion();
    const bool at_servo = std::string(at) == "servo";
    EXPECT_EQ(motion.reference, at_servo ? messaging::GoalReference::deflection : messaging::GoalReference::tip);
    EXPECT_NEAR(motion.goal.x(), 200e-6, 2e-6);
    EXPECT_NEAR(motion.goal.z(), at_servo ? 0.0 : -1e-3, 2e-6);
  }
}

TEST(Servo, EveryCommandIsBoundedExpiresAndNamesItsImage)
{
  servo::ServoOptions options;
  options.speed_bound_mm_s = 25.0;
  ServoBench bench(options);
  bench.assist();
  const auto& motion = *bench.servo->motion();
  EXPECT_DOUBLE_EQ(motion.speed_bound, 0.025);
  EXPECT_DOUBLE_EQ(motion.expiry, 0.05);
  EXPECT_EQ(motion.utime_image, bench.now.utime - 1000 * (bench.steps % 33) - 15'000);
  bench.spoil_state = [](micron_state_t& state) { state.speed_limit = 0.01; };
  bench.run(2);
  EXPECT_DOUBLE_EQ(bench.servo->motion()->speed_bound, 0.01);
}

TEST(Servo, StandbyEndsSoftlyAndThenSaysNothing)
{
  ServoBench bench;
  bench.assist();
  bench.askMode(WantedMode::standby);
  for (int i = 0; i < 1000; ++i) {
    bench.step();
    ASSERT_EQ(bench.state(), State::standby);
    const bool speaks = bench.servo->motion().has_value();
    ASSERT_EQ(speaks, i < kRamp_ms) << i;
    if (speaks) {
      ASSERT_EQ(bench.servo->motion()->mode, MicronMode::cancel_tremor);
    }
  }
}

TEST(Servo, HoldHandsOverAndThenLetsTheControllerCancelTremor)
{
  ServoBench bench;
  bench.assist();
  bench.ask([](OperatorWish& w) { w.stop = true; });
  for (int i = 0; i < 1000; ++i) {
    bench.step();
    ASSERT_EQ(bench.state(), State::hold);
    ASSERT_EQ(bench.servo->motion()->mode, i < kRamp_ms - 1 ? MicronMode::follow : MicronMode::cancel_tremor) << i;
  }
}

TEST(Servo, ClosingHandsOverAndEnds)
{
  ServoBench bench;
  bench.assist();
  bench.servo->close();
  bench.step();
  EXPECT_EQ(bench.state(), State::standby);
  EXPECT_TRUE(bench.servo->motion());
  bench.run(200);
  EXPECT_FALSE(bench.servo->motion());
}

TEST(Servo, StatusComesFiftyTimesASecondAndAtOnceOnChange)
{
  ServoBench bench;
  bench.assist();
  bench.said.clear();
  bench.run(1000);
  EXPECT_NEAR(static_cast<double>(bench.said.size()), 50.0, 1.0);
  bench.run(5);
  bench.said.clear();
  bench.ask([](OperatorWish& w) { w.stop = true; });
  bench.step();
  bench.step();  // a message that was sent in a cycle is heard in the next one
  ASSERT_EQ(bench.said.size(), 1U);
  EXPECT_EQ(bench.said[0].state, messaging::ServoState::hold);
  EXPECT_EQ(bench.said[0].reason, Reason::stopped);
}

TEST(Servo, StatusTellsAgesAndTheTimeFromFrameToCommand)
{
  ServoBench bench;
  bench.run(3);
  EXPECT_EQ(bench.servo->status().pose_age, -1.0);
  EXPECT_EQ(bench.servo->status().frame_to_command, -1.0);
  bench.assist();
  while (bench.steps % 33 != 5) bench.step();
  const messaging::ServoStatus& status = bench.servo->status();
  EXPECT_NEAR(status.pose_age, 0.020, 1e-9);
  EXPECT_NEAR(status.frame_to_command, 0.015, 1e-9);
  EXPECT_EQ(status.state_age, 0.0);
  EXPECT_EQ(status.map_id, ServoBench::kMap);
  EXPECT_EQ(status.cycles, bench.steps);
}

TEST(Servo, TheRegistrationIsToldOnceASecondAndOnChange)
{
  ServoBench bench;
  std::vector<messaging::PublishedRegistration> told;
  messaging::Subscription<registration_t> registrations(
      bench.link,
      [&told](const messaging::PublishedRegistration& r, const messaging::MessageHeader&) { told.push_back(r); });
  bench.run(2500);
  ASSERT_EQ(told.size(), 3U);
  EXPECT_FALSE(told.back().valid);
  EXPECT_EQ(told.back().reason, Reason::not_registered);
  bench.servo->adopt(ServoBench::calibration(), ServoBench::kStart_us);
  bench.run(2);
  ASSERT_EQ(told.size(), 4U);
  EXPECT_TRUE(told.back().valid);
  EXPECT_NEAR(told.back().um_per_px, 5.0, 1e-6);
}

TEST(Servo, CalibratesWithoutARegistrationAndKeepsTheFrames)
{
  ServoBench bench;
  bench.ask([](OperatorWish& w) {
    w.mode = WantedMode::assist;
    w.fixture.kind = FixtureKind::calibration;
    w.map_id = 0;
  });
  double farthest = 0.0;
  for (int i = 0; i < 8500; ++i) {
    bench.step();
    farthest = std::max(farthest, (bench.tip - bench.null).norm());
    ASSERT_LE(bench.tip.z(), bench.null.z() + 5e-6);  // never towards the retina
  }
  EXPECT_EQ(bench.state(), State::assist);
  EXPECT_GT(farthest, 0.8e-3);
  ASSERT_NE(bench.servo->samples(), nullptr);
  EXPECT_GT(bench.servo->samples()->size(), 200U);
  EXPECT_EQ(servo::evaluate(*bench.servo->samples()).reason, Reason::none);
  bench.servo->samplesTaken();
  EXPECT_EQ(bench.servo->samples(), nullptr);
}

TEST(Servo, ACalibrationThatIsBrokenOffLeavesNothing)
{
  ServoBench bench;
  bench.ask([](OperatorWish& w) {
    w.mode = WantedMode::assist;
    w.fixture.kind = FixtureKind::calibration;
  });
  bench.run(4000);
  bench.askMode(WantedMode::ready);
  bench.run(6000);
  EXPECT_EQ(bench.servo->samples(), nullptr);
  EXPECT_LT((bench.tip - bench.null).norm(), 5e-6);
}

TEST(Servo, APreparationWithAScaleOfItsOwnIsNoReasonToStop)
{
  ServoBench bench;
  bench.assist();
  auto preparation = std::make_shared<servo::Preparation>();
  preparation->map_id = ServoBench::kMap;
  preparation->um_per_px = 5.02;
  bench.servo->adopt(preparation);
  for (int i = 0; i < 500; ++i) {
    bench.step();
    ASSERT_EQ(bench.state(), State::assist) << i;
  }
  // The same px are the same place, whatever the metres of the view.
  EXPECT_LT((bench.tip.head<2>() - Eigen::Vector2d(100e-6, 50e-6)).norm(), 2e-6);
}

TEST(Servo, AnImpossibleCommandIsAFault)
{
  servo::ServoOptions options;
  options.cycle.null_at = "controller";
  options.guidance.fixtures.guard.frame_radius_mm = 2000.0;
  ServoBench bench(options);
  // The manipulator's frame ends at 1 m: no message can ask for a tip beyond.
  bench.hand = [](double) { return Eigen::Vector3d(0.9995, 0.0, -1e-3); };
  bench.assist(ServoBench::mapPoint(1.0010, 0.0));
  EXPECT_EQ(bench.state(), State::fault);
  EXPECT_EQ(bench.reason(), Reason::internal_error);
}

}  // namespace
