// SPDX-License-Identifier: GPL-3.0-or-later
// A plan is burnt through messages alone, and whatever stops the servo puts the laser out.
#include <gtest/gtest.h>

#include "eyeslam/servo/servo.h"
#include "support/servo_bench.h"

using namespace eyeslam;
using messaging::LaserAction;
using messaging::OperatorWish;
using messaging::WantedMode;
using retina::Reason;
using servo::State;
using support::ServoBench;

namespace {

/// Three targets about the hand, approved, the laser armed by everyone.
class ServoLaser : public ::testing::Test {
 protected:
  ServoLaser()
  {
    fixtures::BurnPlan plan = support::linePlan(3);
    for (fixtures::BurnTarget& target : plan.targets)
      target.position_px += ServoBench::mapPoint(-300e-6, 0.0) - Eigen::Vector2d(0.0, 20.0);
    const auto prepared = support::preparedFor(plan);
    prepared->map_id = prepared->proposed.map_id = ServoBench::kMap;
    bench.servo->adopt(prepared);
    bench.servo->adopt(ServoBench::calibration(), ServoBench::kStart_us);
    bench.ask([&](OperatorWish& w) {
      w.mode = WantedMode::laser;
      w.arm = w.plan_approved = true;
      w.plan_hash = prepared->proposed.hash;
    });
  }
  void fireFirst()
  {
    for (int i = 0; i < 3000 && !bench.laser.state.emitting; ++i) bench.step();
    ASSERT_TRUE(bench.laser.state.emitting) << retina::word(bench.reason());
    bench.run(5);
    ASSERT_TRUE(bench.laser.state.emitting);
  }
  /// Not lit two cycles later: one to command, one for the message.
  void expectOut(State state)
  {
    EXPECT_EQ(bench.state(), state) << retina::word(bench.reason());
    bench.step();
    EXPECT_FALSE(bench.laser.state.emitting);
    bench.run(500);
    EXPECT_FALSE(bench.laser.state.aiming);
    EXPECT_EQ(bench.laser.pulses.size(), 1U);
  }

  ServoBench bench;
};

TEST_F(ServoLaser, BurnsAnApprovedPlanInItsOrder)
{
  bench.run(4000);
  EXPECT_EQ(bench.state(), State::laser) << retina::word(bench.reason());
  EXPECT_EQ(bench.laser.pulses, (std::vector<int>{10, 11, 12}));
  EXPECT_EQ(bench.servo->ledger().count(servo::Fate::done), 3U);
}

TEST_F(ServoLaser, WithoutAnApprovalThereIsNoLaser)
{
  bench.ask([](OperatorWish& w) {
    w.plan_approved = false;
    w.plan_hash = {};
  });
  bench.run(3000);
  EXPECT_EQ(bench.state(), State::ready);
  EXPECT_EQ(bench.reason(), Reason::plan_not_in_force);
  EXPECT_TRUE(bench.laser.pulses.empty());
}

TEST_F(ServoLaser, AHumanWhoStopsPutsItOut)
{
  fireFirst();
  bench.ask([](OperatorWish& w) { w.stop = true; });
  bench.step();
  expectOut(State::hold);
}

TEST_F(ServoLaser, ARivalPutsItOut)
{
  fireFirst();
  bench.put("MICRON_COMMAND", bench.foreign<micron_command_t>(messaging::MicronCommand{}, 55, 0));
  bench.step();
  expectOut(State::fault);
}

TEST_F(ServoLaser, ASilentManipulatorPutsItOut)
{
  fireFirst();
  bench.controller_speaks = false;
  for (int i = 0; i < 51; ++i) bench.step();
  expectOut(State::hold);
}

TEST_F(ServoLaser, ThePoseThatJumpsPutsItOut)
{
  fireFirst();
  bench.spoil_pose = [](retina_pose_t& pose) { pose.x_px += 400.0; };
  while (bench.state() == State::laser) bench.step();
  EXPECT_EQ(bench.reason(), Reason::pose_jumped);
  expectOut(State::hold);
}

TEST_F(ServoLaser, ATargetThatIsGivenUpIsLeftByTheRampAlone)
{
  bench.laser.state.foot_switch = false;
  for (const WantedMode mode : {WantedMode::ready, WantedMode::assist}) {
    bench.askMode(WantedMode::laser);
    bench.ask([](OperatorWish& w) {
      w.fixture.kind = messaging::FixtureKind::point;
      w.fixture.point_px = ServoBench::mapPoint(300e-6, 300e-6);
    });
    bench.run(800);
    ASSERT_EQ(bench.state(), State::laser) << retina::word(bench.reason());
    Eigen::Vector3d before = bench.tip;
    double fastest = 0.0;
    bench.after_cycle = [&] {
      fastest = std::max(fastest, (bench.tip - before).norm() / 1e-3);
      before = bench.tip;
    };
    const double farthest = (bench.tip - bench.null).norm();
    ASSERT_GT(farthest, 200e-6);
    bench.askMode(mode);
    bench.run(400);
    // The steepest part of a smooth ramp of 150 ms, to the hand and on to a fixture 0.4 mm away.
    EXPECT_LT(fastest, 1.7 * (farthest + 0.5e-3) / 0.15) << static_cast<int>(mode);
    bench.after_cycle = nullptr;
  }
}

TEST_F(ServoLaser, NothingIsAimedOutsideOfLaser)
{
  fireFirst();
  bench.askMode(WantedMode::ready);
  bench.step();
  expectOut(State::ready);
}

}  // namespace
