// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/servo_cycle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <random>
#include <vector>

#include "support/allocation_counter.h"
#include "support/sanitized.h"

namespace eyeslam::servo {
namespace {

using retina::Reason;

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

ManipulatorState stateAt(std::int64_t now, const Eigen::Vector3d& null)
{
  return {now - 1000, null, null, Eigen::Vector2d(1e-6, 0.0)};
}

/// A cycle on a still retina and a still hand.
CycleInput quiet(int i)
{
  CycleInput input;
  input.now = kStart_us + 1000 * i;
  input.state = stateAt(input.now, Eigen::Vector3d::Zero());
  if (i % 33 == 0) {
    input.pose = SeenPose{input.now - 15000, {}, 0.0, 0.0};
    input.tip = SeenTip{input.now - 15000, 8e-3, Eigen::Vector2d::Zero(), 0.0};
  }
  return input;
}

void runQuiet(ServoCycle& cycle, int from, int to, const Eigen::Vector3d& goal)
{
  for (int i = from; i < to; ++i) {
    cycle.observe(quiet(i));
    cycle.command(goal);
  }
}

TEST(ServoCycle, BringsTheDeflectionToTheGoal)
{
  ServoCycleOptions options;
  options.integral.rate_per_s = 0.0;  // the tip of this test does not follow
  ServoCycle cycle(options, {});
  const Eigen::Vector3d goal(100e-6, -50e-6, 20e-6);
  runQuiet(cycle, 0, 1000, goal);
  cycle.observe(quiet(1000));
  const ServoCommand& command = cycle.command(goal);
  EXPECT_EQ(command.reason, Reason::none);
  EXPECT_LT((command.position - goal).norm(), 1e-9);
  EXPECT_LT((command.goal - goal).norm(), 1e-9);
}

TEST(ServoCycle, WhereTheControllerSubtractsTheNullItGetsTheSameTip)
{
  ServoCycleOptions options;
  options.integral.rate_per_s = 0.0;
  ServoCycle at_servo(options, {});
  options.null_at = "controller";
  ServoCycle at_controller(options, {});
  for (int i = 0; i < 2000; ++i) {
    const double t = 1e-3 * i;
    const Eigen::Vector3d null(1e-4 * std::sin(60.0 * t), 2e-4 * std::sin(3.0 * t), 0.0);
    CycleInput input = quiet(i);
    input.state = stateAt(input.now, null);
    at_servo.observe(input);
    at_controller.observe(input);
    const Eigen::Vector3d deflection = at_servo.command(Eigen::Vector3d::Zero()).position;
    const Eigen::Vector3d tip_goal = at_controller.command(Eigen::Vector3d::Zero()).position;
    // The controller subtracts the null of now, which the servo expected from the state of 1 ms ago.
    if (i > 1000) {
      ASSERT_LT((tip_goal - at_controller.hand().at(input.now) - deflection).norm(), 1e-12);
    }
  }
}

TEST(ServoCycle, SaysWhatIsMissing)
{
  ServoCycle cycle({}, {});
  CycleInput input;
  input.now = kStart_us;
  EXPECT_EQ(cycle.observe(input).reason, Reason::no_state);
  EXPECT_EQ(cycle.command(Eigen::Vector3d::Zero()).position, Eigen::Vector3d::Zero());
  input.now += 1000;
  input.state = stateAt(input.now, Eigen::Vector3d::Zero());
  EXPECT_EQ(cycle.observe(input).reason, Reason::no_pose);
  input = quiet(33);
  EXPECT_EQ(cycle.observe(input).reason, Reason::none);
  for (int i = 34; i < 320; ++i) {
    input = quiet(i);
    input.pose.reset();
    // 250 ms after the pose's exposure, which was 15 ms before cycle 33 (contracts, section 4)
    ASSERT_EQ(cycle.observe(input).reason, i <= 33 - 15 + 250 ? Reason::none : Reason::pose_stale) << i;
  }
  for (int i = 320; i < 400; ++i) {
    CycleInput silence;
    silence.now = kStart_us + 1000 * i;
    const Reason reason = cycle.observe(silence).reason;
    if (i > 318 + 50) {
      ASSERT_EQ(reason, Reason::state_stale) << i;
    }
  }
}

TEST(ServoCycle, AGoalThatIsNoneGivesWayToTheHandAndIsCounted)
{
  ServoCycle cycle({}, {});
  runQuiet(cycle, 0, 500, {100e-6, 0.0, 0.0});
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Constant(std::nan(""));
  for (int i = 500; i < 800; ++i) {
    cycle.observe(quiet(i));
    ASSERT_EQ(cycle.command(nowhere).reason, Reason::goal_not_finite);
  }
  EXPECT_EQ(cycle.command(nowhere).share, 0.0);
  EXPECT_LT(cycle.command(nowhere).goal.norm(), 1e-6);  // the hand's place
  EXPECT_GE(cycle.refusals().of(Reason::goal_not_finite), 300);
}

TEST(ServoCycle, AGoalFarBeyondTheReachGivesWayToTheHand)
{
  ServoCycle cycle({}, {});
  runQuiet(cycle, 0, 1000, Eigen::Vector3d(1e-3, 0.0, 0.0));
  runQuiet(cycle, 1000, 3000, Eigen::Vector3d(4.1e-3, 0.0, 0.0));
  EXPECT_EQ(cycle.last().reason, Reason::out_of_reach);
  EXPECT_LT(cycle.last().goal.norm(), 1e-6) << "the hand is at the origin";
}

TEST(ServoCycle, ARefinedPlacementMovesNothing)
{
  ServoCycle cycle({}, {});
  const Eigen::Vector3d wanted(300e-6, -200e-6, 0.0);
  runQuiet(cycle, 0, 1000, wanted);
  const Eigen::Vector3d before = cycle.last().goal;
  ViewPlacement refined;
  refined.manipulator_T_view.linear() *= 1.01;
  refined.manipulator_T_view.translation() = Eigen::Vector3d(40e-6, -30e-6, 0.0);
  cycle.setPlacement(refined);
  for (int i = 1000; i < 1010; ++i) {
    cycle.observe(quiet(i));
    ASSERT_LT((cycle.command(wanted).goal - before).head<2>().norm(), 1e-9) << i;
  }
  // And the trim goes on from there: tips are still seen where they were.
  runQuiet(cycle, 1010, 2000, wanted);
  EXPECT_LT((cycle.last().goal - before).head<2>().norm(), 1e-6);
  EXPECT_EQ(cycle.refusals().of(Reason::tip_far), 0);
}

TEST(ServoCycle, AnotherPlacementIsGoneToWithoutAStep)
{
  ServoCycle cycle({}, {});
  const Eigen::Vector3d wanted(300e-6, 0.0, 0.0);
  runQuiet(cycle, 0, 1000, wanted);
  Eigen::Vector3d last = cycle.last().goal, velocity = Eigen::Vector3d::Zero();
  ViewPlacement other;
  other.manipulator_T_view.translation() = Eigen::Vector3d(600e-6, 0.0, 0.0);
  cycle.setPlacement(other);
  for (int i = 1000; i < 1500; ++i) {
    cycle.observe(quiet(i));
    const Eigen::Vector3d now = (cycle.command(wanted).goal - last) / 1e-3;
    ASSERT_LE(now.norm(), 20e-3 * (1.0 + 1e-9));
    ASSERT_LE((now - velocity).norm(), 8e-3 * (1.0 + 1e-6));
    last = cycle.last().goal;
    velocity = now;
  }
  EXPECT_GT(last.x(), 850e-6);
}

TEST(ServoCycle, AfterARestItBeginsWhereTheTipIs)
{
  ServoCycle cycle({}, {});
  runQuiet(cycle, 0, 500, {300e-6, 0.0, 0.0});
  cycle.rest();
  CycleInput input = quiet(500);
  input.state->tip = Eigen::Vector3d(-100e-6, 50e-6, 0.0);
  cycle.observe(input);
  const ServoCommand& command = cycle.command({300e-6, 0.0, 0.0});
  EXPECT_LT((command.goal - input.state->tip).norm(), 10e-6);
  EXPECT_LT((command.deflection - input.state->tip).norm(), 40e-6);
  EXPECT_LT((command.position - input.state->tip).norm(), 200e-6);  // what the plant needs to begin, not its past
}

// 5 % of the way after 20 of 150 ms, where the limits alone would let it go 360 um.
TEST(ServoCycle, AGoalThatIsLostFades)
{
  ServoCycle cycle({}, {});
  runQuiet(cycle, 0, 500, {500e-6, 0.0, 0.0});
  runQuiet(cycle, 500, 520, Eigen::Vector3d::Constant(std::nan("")));
  EXPECT_GT(cycle.last().goal.x(), 470e-6);
}

// Anything may come in: out of order, NaN, from the future, far away. What goes out stays finite and within the limits.
TEST(ServoCycle, WhateverComesInTheCommandIsFiniteAndItsGoalSlow)
{
  const double odd[] = {std::nan(""), INFINITY, -INFINITY, 1e300, -1e300, 0.0, 1.0};
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> which(0, 6), chance(0, 99);
    const auto number = [&](double usual) { return chance(random) < 3 ? odd[which(random)] : usual; };
    const auto time = [&](std::int64_t usual) {
      return chance(random) < 3 ? usual + 100'000 * (which(random) - 3) : usual;
    };
    ServoCycle cycle({}, {});
    Eigen::Vector3d goal = Eigen::Vector3d::Zero();
    std::int64_t last = 0;
    for (int i = 0; i < 1500; ++i) {
      CycleInput input = quiet(i);
      input.now = time(input.now);
      input.state->utime = time(input.state->utime);
      input.state->null = {number(1e-5), number(0.0), number(1e-6)};
      input.state->tip = {number(1e-5), number(0.0), number(1e-6)};
      input.state->port = Eigen::Vector2d(number(1e-5), number(0.0));
      if (input.pose) input.pose->view_T_retina = {number(1e-5), number(0.0), number(0.001), number(1.0)};
      if (input.tip) input.tip->view = {number(1e-5), number(0.0)};
      const double step = cycle.observe(input).step_s;
      const ServoCommand command = cycle.command({number(1e-4), number(0.0), number(0.0)});
      ASSERT_TRUE(command.position.allFinite() && command.goal.allFinite()) << seed << ", " << i;
      ASSERT_LE(command.position.norm(), 2e-3 * (1.0 + 1e-9));
      if (last != 0) {
        ASSERT_LE((command.goal - goal).norm(), 20e-3 * std::min(step, 5e-3) * (1.0 + 1e-9) + 1e-12);
      }
      if (command.reason != Reason::no_state) last = input.now;
      goal = command.goal;
    }
    EXPECT_GT(cycle.refusals().total(), 10);
  }
}

TEST(ServoCycle, NeverAllocates)
{
  ServoCycle cycle({}, {});
  const std::int64_t before = support::allocations();
  runQuiet(cycle, 0, 1000, {1e-4, 0.0, 0.0});
  EXPECT_EQ(support::allocations(), before);
}

double cpuSeconds()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A machine's speed is not known here, so the cycle is compared with arithmetic that takes a known number of steps:
// 10,000 dependent divisions, about 50 us on a processor of 2 to 3 GHz, which is what a cycle may take (issue 16).
TEST(ServoCycle, TakesLessTimeThanTenThousandDivisions)
{
  if (support::kSanitized) GTEST_SKIP() << "sanitizers slow the cycle down, and not the divisions";
  ServoCycle cycle({}, {});
  runQuiet(cycle, 0, 1000, {1e-4, 0.0, 0.0});
  std::vector<double> cycles, divisions;
  volatile double sink = 1.0;
  for (int i = 1000; i < 3000; ++i) {
    const double start = cpuSeconds();
    runQuiet(cycle, i, i + 1, {1e-4, 0.0, 0.0});
    const double middle = cpuSeconds();
    double x = 1.0 + sink;
    for (int k = 0; k < 10000; ++k) x = 3.0 / x;
    sink = x;
    cycles.push_back(middle - start);
    divisions.push_back(cpuSeconds() - middle);
  }
  const auto median = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  EXPECT_LT(median(cycles), median(divisions));
}

}  // namespace
}  // namespace eyeslam::servo
