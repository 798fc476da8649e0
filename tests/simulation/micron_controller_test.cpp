// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/micron_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "eyeslam/simulation/random.h"
#include "support/allocation_counter.h"

namespace eyeslam::simulation {
namespace {

using messaging::GoalReference;
using messaging::MicronCommand;
using messaging::MicronMode;
using messaging::MicronState;
using retina::Reason;

constexpr double kPeriod_s = 1e-3;
const Eigen::Vector3d kShaft = Eigen::Vector3d(0.3, -0.4, -std::sqrt(0.75));  // up, a unit vector
const Eigen::Vector3d kAcross = kShaft.unitOrthogonal();

Eigen::Isometry3d turned()
{
  Eigen::Isometry3d manipulator_T_world = Eigen::Isometry3d::Identity();
  manipulator_T_world.translation() = Eigen::Vector3d(0.03, -0.02, 0.05);
  manipulator_T_world.rotate(Eigen::AngleAxisd(2.0, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()));
  return manipulator_T_world;
}

MicronControllerOptions exact()
{
  MicronControllerOptions options;
  options.plant.gain_error = options.plant.bend_um = options.plant.noise_um = 0.0;
  return options;
}

/// A controller in a hand that the test moves, and the last command it has heard.
class Held {
 public:
  explicit Held(const MicronControllerOptions& options) : controller(options, turned(), 1) {}

  MicronCommand& follow(const Eigen::Vector3d& goal_world, double speed_bound = 0.02)
  {
    command = {};
    command.mode = MicronMode::follow;
    command.goal = turned() * goal_world;
    command.speed_bound = speed_bound;
    heard.command = &command;
    heard.age = 1e-3;
    return command;
  }
  MicronCommand& deflect(const Eigen::Vector3d& deflection_world, double speed_bound = 0.02)
  {
    follow(Eigen::Vector3d::Zero(), speed_bound);
    command.reference = GoalReference::deflection;
    command.goal = turned().linear() * deflection_world;
    return command;
  }
  const MicronState& step(int periods = 1)
  {
    for (int i = 0; i < periods; ++i) controller.step(hand, heard);
    return controller.state();
  }
  Eigen::Vector3d goalWorld() const { return turned().inverse() * controller.state().goal; }
  Eigen::Vector3d deflection() const { return controller.tip() - hand.null; }

  MicronController controller;
  HeldManipulator hand{Eigen::Vector3d(4e-3, 3e-3, -5e-4), kShaft, Eigen::Vector2d::Zero()};
  MicronCommand command;
  HeardCommand<MicronCommand> heard;
};

TEST(MicronController, SaysWhyItFollowsNoCommand)
{
  Held micron(exact());
  EXPECT_EQ(micron.step().reason, Reason::no_command);
  EXPECT_TRUE(micron.controller.state().cancels_tremor);
  micron.follow(micron.hand.null);
  EXPECT_EQ(micron.step().reason, Reason::none);
  EXPECT_TRUE(micron.controller.state().follows_command);
  micron.command.mode = MicronMode::cancel_tremor;
  EXPECT_EQ(micron.step().reason, Reason::other_mode);
  EXPECT_TRUE(micron.controller.state().cancels_tremor);
  micron.command.mode = MicronMode::at_null;
  EXPECT_EQ(micron.step().reason, Reason::other_mode);
  EXPECT_FALSE(micron.controller.state().cancels_tremor);
  micron.heard.fault = Reason::clock_stepped;
  EXPECT_EQ(micron.step().reason, Reason::clock_stepped);
  EXPECT_TRUE(micron.controller.state().cancels_tremor);
  micron.controller.setPowered(false);
  EXPECT_EQ(micron.step().reason, Reason::not_powered);
  EXPECT_FALSE(micron.controller.state().powered);
}

TEST(MicronController, FollowsACommandUntilItExpires)
{
  Held micron(exact());
  micron.follow(micron.hand.null + 1e-3 * kAcross);
  micron.command.expiry = 0.02;
  micron.heard.age = 0.02;
  EXPECT_TRUE(micron.step().follows_command);
  micron.heard.age = 0.021;
  EXPECT_EQ(micron.step().reason, Reason::expired);
  EXPECT_TRUE(micron.controller.state().cancels_tremor);
  micron.step(400);
  EXPECT_LT(micron.deflection().norm(), 1e-6);
}

TEST(MicronController, NoCommandLivesLongerThanTheControllerAllows)
{
  Held micron(exact());
  micron.follow(micron.hand.null);
  micron.command.expiry = 1.0;
  micron.heard.age = 0.05;
  EXPECT_TRUE(micron.step().follows_command);
  micron.heard.age = 0.051;
  EXPECT_EQ(micron.step().reason, Reason::expired);
}

TEST(MicronController, BothWaysToSubtractTheNullLeadToTheSamePlace)
{
  const Eigen::Vector3d way = 3e-4 * kAcross + 2e-4 * kShaft;
  Held by_goal(exact());
  by_goal.follow(by_goal.hand.null + way);
  by_goal.step(600);
  EXPECT_LT((by_goal.deflection() - way).norm(), 1e-9);
  EXPECT_LT((by_goal.goalWorld() - by_goal.hand.null - way).norm(), 1e-9);
  Held by_deflection(exact());
  by_deflection.deflect(way);
  by_deflection.step(600);
  EXPECT_LT((by_deflection.deflection() - way).norm(), 1e-9);
}

TEST(MicronController, ALostCommandHandsTheTipOverInThePromisedTime)
{
  Held micron(exact());
  const double distance = 1e-3;
  micron.follow(micron.hand.null + distance * kAcross);
  micron.step(1000);
  micron.heard.age = 0.1;
  double fastest = 0.0;
  Eigen::Vector3d last = micron.controller.tip();
  for (int i = 0; i < 250; ++i) {
    micron.step();
    fastest = std::max(fastest, (micron.controller.tip() - last).norm() / kPeriod_s);
    last = micron.controller.tip();
    if (i == 75) {
      EXPECT_NEAR(micron.deflection().norm(), 0.5 * distance, 0.1 * distance);
    }
  }
  EXPECT_LT(micron.deflection().norm(), 0.01 * distance);
  // The steepest place of a smoothstep: 1.5 x the way in its time; a step would be as fast as the motors.
  EXPECT_LT(fastest, 1.1 * 1.5 * distance / 0.15);
}

TEST(MicronController, NeverStepsWhateverIsCommanded)
{
  // Modes, references, goals, lost commands and power in any order, with sensor noise: the tip stays within the speed
  // that is bound by the commands, the controller's own 20 mm/s and the hand, and within the motors' overshoot.
  MicronControllerOptions options;
  options.plant.gain_error = options.plant.bend_um = 0.0;
  Held micron(options);
  Random random(3);
  const auto any = [&](double size) -> Eigen::Vector3d {
    return size * Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  const Eigen::Vector3d middle = micron.hand.null;
  Eigen::Vector3d last_tip = middle;
  double fastest = 0.0;
  for (int i = 0; i < 30'000; ++i) {
    const double phase = 60.0 * i * kPeriod_s;  // a tremor of 9.5 Hz, 4.2 mm/s
    micron.hand.null = middle + 7e-5 * std::sin(phase) * kAcross;
    if (random.chance(0.01)) {
      if (random.chance(0.5)) {
        micron.follow(middle + any(2e-3), 0.01);
      } else {
        micron.deflect(any(2e-3), 0.01);
      }
      if (random.chance(0.3))
        micron.command.mode = random.chance(0.5) ? MicronMode::at_null : MicronMode::cancel_tremor;
      micron.heard.age = random.chance(0.2) ? 0.1 : 1e-3;
      micron.controller.setPowered(random.chance(0.9));
    }
    micron.step();
    fastest = std::max(fastest, (micron.controller.tip() - last_tip).norm() / kPeriod_s);
    last_tip = micron.controller.tip();
  }
  EXPECT_LT(fastest, 0.03);
  EXPECT_GT(fastest, 0.01);
}

TEST(MicronController, TheSpeedBoundOfACommandHolds)
{
  for (const double bound : {0.002, 0.01}) {
    for (const bool subtracts : {true, false}) {
      Held micron(exact());
      micron.step(10);
      const Eigen::Vector3d way = 1.5e-3 * kAcross;
      if (subtracts) {
        micron.follow(micron.hand.null + way, bound);
      } else {
        micron.deflect(way, bound);
      }
      double fastest = 0.0;
      bool told = false;
      Eigen::Vector3d last = micron.controller.tip();
      for (int i = 0; i < 1200; ++i) {
        told = micron.step().limits.speed || told;
        fastest = std::max(fastest, (micron.controller.tip() - last).norm() / kPeriod_s);
        last = micron.controller.tip();
      }
      EXPECT_LT(fastest, 1.06 * bound);  // damping 0.7 overshoots by 4.6 %
      EXPECT_TRUE(told);
      EXPECT_LT((micron.deflection() - way).norm(), 1e-6);
    }
  }
}

TEST(MicronController, BoundsTheMotionNotACommandThatLeadsASlowPlant)
{
  // What makes the plant answer faster than it is jitters by more in a millisecond than the tip may move in it.
  Held micron(exact());
  bool told = false;
  for (int i = 0; i < 500; ++i) {
    micron.deflect((i % 2 == 0 ? 1.0 : -1.0) * 1.5e-5 * kAcross, 0.01);  // 30 mm/s
    told = micron.step().limits.speed || told;
  }
  EXPECT_FALSE(told);
}

TEST(MicronController, ReachesACylinderAboutTheNullAlongTheShaft)
{
  const auto reached = [](const Eigen::Vector3d& wanted) {
    Held micron(exact());
    micron.deflect(wanted);
    micron.step(1500);
    return std::make_pair(micron.deflection(), micron.controller.state().limits);
  };
  const auto [across, across_limits] = reached(3e-3 * kAcross);
  EXPECT_LT((across - 2e-3 * kAcross).norm(), 1e-9);
  EXPECT_TRUE(across_limits.lateral);
  EXPECT_FALSE(across_limits.axial);
  const auto [along, along_limits] = reached(-3e-3 * kShaft);
  EXPECT_LT((along + 2e-3 * kShaft).norm(), 1e-9);
  EXPECT_FALSE(along_limits.lateral);
  EXPECT_TRUE(along_limits.axial);
  const auto [edge, edge_limits] = reached(1.9e-3 * kAcross + 1.9e-3 * kShaft);
  EXPECT_NEAR(edge.norm(), 1.9e-3 * std::sqrt(2.0), 1e-9);
  EXPECT_FALSE(edge_limits.any());
}

TEST(MicronController, ItsOwnFilterCutsTremorAndLetsTheHandThrough)
{
  Held micron(exact());
  const Eigen::Vector3d middle = micron.hand.null;
  double tremor = 0.0, left = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double t = i * kPeriod_s;
    const double shaken = 1e-4 * std::sin(2.0 * 3.14159265358979 * 9.0 * t);
    micron.hand.null = middle + shaken * kAcross;
    micron.step();
    if (i < 1000) continue;
    tremor += shaken * shaken;
    left += std::pow((micron.controller.tip() - middle).dot(kAcross), 2);
  }
  // By hand: 10 % of it passes, and the motors come 4.8 ms after the hand, 27 % of a radian at 9 Hz.
  EXPECT_LT(std::sqrt(left / tremor), 0.4);
  micron.hand.null = middle + 1e-3 * kAcross;
  micron.step(1500);
  EXPECT_LT(micron.deflection().norm(), 1e-6);
}

TEST(MicronController, WithoutPowerTheTipGoesWithTheHand)
{
  Held micron(exact());
  micron.follow(micron.hand.null + 5e-4 * kAcross);
  micron.step(500);
  micron.controller.setPowered(false);
  micron.step(10);
  const Eigen::Vector3d held = micron.deflection();
  micron.hand.null += Eigen::Vector3d(1e-3, 0.0, 0.0);
  micron.step(300);
  EXPECT_LT((micron.deflection() - held).norm(), 1e-9);
}

TEST(MicronController, TellsPosesInTheManipulatorsFrame)
{
  Held micron(exact());
  micron.follow(micron.hand.null + 5e-4 * kAcross);
  const MicronState& state = micron.step(500);
  const Eigen::Isometry3d frame = turned();
  EXPECT_LT((state.null.position - frame * micron.hand.null).norm(), 1e-9);
  EXPECT_LT((state.tip.position - frame * micron.controller.tip()).norm(), 1e-9);
  EXPECT_LT((state.handle.position - frame * (micron.hand.null + 0.06 * kShaft)).norm(), 1e-9);
  // The tool's z axis goes down the shaft.
  const Eigen::Vector3d down = frame.linear() * -kShaft;
  EXPECT_LT((state.null.orientation * Eigen::Vector3d::UnitZ() - down).norm(), 1e-9);
  EXPECT_LT((state.tip.orientation * Eigen::Vector3d::UnitZ() - down).norm(), 1e-6);
}

TEST(MicronController, AllocatesNothing)
{
  Held micron({});
  micron.follow(micron.hand.null + 5e-4 * kAcross);
  micron.step();
  const std::int64_t before = support::allocations();
  micron.step(100);
  micron.heard.age = 1.0;
  micron.step(100);
  EXPECT_EQ(support::allocations(), before);
}

/// The port wanders by 0.6 mm and trembles; the hand's shaft goes through it, the tip holds its place.
double worstPivotError(Held& micron, const Eigen::Vector3d& pivot, int periods)
{
  const Eigen::Vector3d null = micron.hand.null;
  double worst = 0.0;
  for (int i = 0; i < periods; ++i) {
    const double t = i * kPeriod_s;
    const Eigen::Vector3d port = pivot + Eigen::Vector3d(6e-4 * std::sin(3.0 * t),
                                                         4e-4 * std::sin(4.0 * t + 1.0) + 3e-5 * std::sin(60.0 * t), 0);
    micron.hand.null = null + 1e-4 * std::sin(57.0 * t) * kAcross;
    micron.hand.shaft = (port - micron.hand.null).normalized();
    micron.step();
    const Eigen::Vector3d shaft = micron.controller.shaft();
    if (i > 200) worst = std::max(worst, (pivot - micron.controller.tip()).cross(shaft).norm());
  }
  return worst;
}

TEST(MicronController, KeepsTheShaftAtItsPivot)
{
  Held micron({});  // with noise, bending and wrong gains
  const Eigen::Vector3d pivot = micron.hand.null + 0.02 * kShaft;
  MicronCommand& command = micron.follow(micron.hand.null + 5e-4 * kAcross);
  command.keep_pivot = true;
  command.pivot = turned() * pivot;
  EXPECT_LT(worstPivotError(micron, pivot, 4000), 100e-6);
  EXPECT_TRUE(micron.controller.state().keeps_pivot);
  EXPECT_FALSE(micron.controller.state().limits.pivot);
  EXPECT_LT(micron.controller.pivotError(), 100e-6);

  Held without({});
  without.follow(without.hand.null + 5e-4 * kAcross);
  EXPECT_GT(worstPivotError(without, pivot, 4000), 500e-6);
  EXPECT_FALSE(without.controller.state().keeps_pivot);
}

TEST(MicronController, SaysWhenItCannotKeepThePivot)
{
  Held micron(exact());
  MicronCommand& command = micron.follow(micron.hand.null);
  command.keep_pivot = true;
  command.pivot = turned() * (micron.hand.null + 0.02 * kShaft + 5e-3 * kAcross);  // 14 deg; 8 can be
  micron.step(500);
  EXPECT_TRUE(micron.controller.state().limits.pivot);
  EXPECT_FALSE(micron.controller.state().keeps_pivot);
  EXPECT_NEAR(std::acos(micron.controller.shaft().dot(kShaft)), 8.0 * 3.14159265 / 180.0, 1e-3);
}

TEST(MicronController, ThePivotComesAndGoesWithoutAStep)
{
  Held micron(exact());
  micron.step(10);
  MicronCommand& command = micron.follow(micron.hand.null);
  const Eigen::Vector3d pivot = micron.hand.null + 0.02 * kShaft + 1e-3 * kAcross;
  Eigen::Vector3d last = micron.controller.shaft();
  double fastest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    command.keep_pivot = i / 250 % 2 == 0;
    command.pivot = command.keep_pivot ? Eigen::Vector3d(turned() * pivot) : Eigen::Vector3d::Zero();
    micron.step();
    fastest = std::max(fastest, 0.02 * (micron.controller.shaft() - last).norm() / kPeriod_s);
    last = micron.controller.shaft();
  }
  EXPECT_LT(fastest, 1.1 * 1.5 * 1e-3 / 0.15);  // of the shaft's point at the pivot: a smoothstep of 1 mm in 150 ms
}

}  // namespace
}  // namespace eyeslam::simulation
