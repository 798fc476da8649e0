// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/motion_limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace eyeslam::servo {
namespace {

constexpr double kRounding = 1e-9;  // relative; a step's difference of two places 10 mm away
constexpr double kPeriod_s = 1e-3;

double wild(std::mt19937& random)
{
  static const double kOdd[] = {0.0,
                                std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::max(),
                                -std::numeric_limits<double>::max(),
                                std::numeric_limits<double>::denorm_min(),
                                1e300};
  std::uniform_int_distribution<int> kind(0, 19);
  const int which = kind(random);
  if (which < 8) return kOdd[which];
  return std::normal_distribution<double>(0.0, which < 14 ? 1e-4 : 5e-3)(random);
}

Eigen::Vector3d wildPlace(std::mt19937& random, const Eigen::Vector3d& near)
{
  if (std::bernoulli_distribution(0.5)(random)) {
    std::normal_distribution<double> small(0.0, 3e-4);
    return near + Eigen::Vector3d(small(random), small(random), small(random));
  }
  return {wild(random), wild(random), wild(random)};
}

// Sequences of inputs that hold for a while, as a fault would, with time steps of any kind.
TEST(MotionLimiter, NeverExceedsSpeedAndAccelerationOfTheGoalForAnyInput)
{
  const MotionLimiterOptions options;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    MotionLimiter limiter(options);
    Eigen::Vector3d goal = limiter.goal(Eigen::Vector3d::Zero(), kPeriod_s);
    Eigen::Vector3d velocity = limiter.velocity(), wanted = goal;
    for (int i = 0; i < 300; ++i) {
      if (i % 7 == 0) wanted = wildPlace(random, goal);
      const double step = i % 13 == 0 ? wild(random) : kPeriod_s;
      const double counted = step > 0.0 ? std::min(step, MotionLimiter::kLongestStep_s) : 0.0;
      const Eigen::Vector3d next = limiter.goal(wanted, step);
      ASSERT_TRUE(next.allFinite()) << seed << ", " << i;
      ASSERT_LE((next - goal).norm(), 1e-3 * options.speed_mm_s * counted * (1.0 + kRounding) + 1e-15);
      ASSERT_LE((limiter.velocity() - velocity).norm(),
                options.acceleration_m_s2 * counted * (1.0 + kRounding) + 1e-15);
      goal = next;
      velocity = limiter.velocity();
    }
  }
}

TEST(MotionLimiter, NeverExceedsReachAndActuatorSpeedOfTheDeflectionForAnyInput)
{
  const MotionLimiterOptions options;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed + 1000);
    MotionLimiter limiter(options);
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
    for (int i = 0; i < 300; ++i) {
      const double step = i % 13 == 0 ? wild(random) : kPeriod_s;
      const double counted = step > 0.0 ? std::min(step, MotionLimiter::kLongestStep_s) : 0.0;
      const Eigen::Vector3d next = limiter.deflection(wildPlace(random, last), step);
      ASSERT_TRUE(next.allFinite());
      ASSERT_LE(next.norm(), 1e-3 * options.reach_mm * (1.0 + kRounding));
      ASSERT_LE((next - last).norm(), 1e-3 * options.actuator_mm_s * counted * (1.0 + kRounding) + 1e-15);
      last = next;
    }
  }
}

TEST(MotionLimiter, ArrivesInLittleMoreThanTheWayTakesWithLessThan2PercentOvershoot)
{
  for (const double way : {10e-6, 50e-6, 100e-6, 300e-6, 1e-3}) {
    MotionLimiter limiter({});
    const Eigen::Vector3d there = way * Eigen::Vector3d(0.6, 0.0, 0.8);
    double farthest = 0.0, arrived_s = 0.0;
    for (int i = 1; i <= 200; ++i) {
      const Eigen::Vector3d goal = limiter.goal(there, kPeriod_s);
      farthest = std::max(farthest, goal.dot(there) / (way * way));
      if ((goal - there).norm() > 0.05 * way) arrived_s = i * kPeriod_s;
    }
    EXPECT_LE(farthest, 1.02) << way;  // the demand on a step of the tip
    // 20 mm/s, and 10 ms for starting and braking: the demand on a step of the tip.
    EXPECT_LE(arrived_s, way / 20e-3 + 10e-3) << way;
  }
}

TEST(MotionLimiter, FollowsAMovingGoalWithoutLagOnceItHasCaughtUp)
{
  MotionLimiter limiter({});
  Eigen::Vector3d wanted = Eigen::Vector3d::Zero();
  for (int i = 0; i < 100; ++i) {
    wanted += Eigen::Vector3d(4e-6, -3e-6, 0.0);  // 5 mm/s
    limiter.goal(wanted, kPeriod_s);
  }
  EXPECT_LT((limiter.goal(wanted, kPeriod_s) - wanted).norm(), 1e-12);
}

TEST(MotionLimiter, WithoutAFiniteGoalItBrakesToAStandAndStays)
{
  MotionLimiter limiter({});
  for (int i = 0; i < 50; ++i) limiter.goal({1.0, 0.0, 0.0}, kPeriod_s);
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Eigen::Vector3d start = limiter.goal(nowhere, kPeriod_s);
  for (int i = 0; i < 20; ++i) limiter.goal(nowhere, kPeriod_s);
  const Eigen::Vector3d stand = limiter.goal(nowhere, kPeriod_s);
  EXPECT_EQ(limiter.goal(nowhere, kPeriod_s), stand);
  EXPECT_LE((stand - start).norm(), 20e-3 * 20e-3 / (2.0 * 8.0) * 1.5);  // v^2 / 2a, a period's half more
}

TEST(MotionLimiter, SaysWhenTheReachEnds)
{
  MotionLimiter limiter({});
  limiter.deflection({1.9e-3, 0.0, 0.0}, kPeriod_s);
  EXPECT_FALSE(limiter.isSaturated());
  limiter.deflection({1.9e-3, 0.0, 1.0e-3}, kPeriod_s);
  EXPECT_TRUE(limiter.isSaturated());
  EXPECT_LE(limiter.withinReach({1.0, 1.0, 1.0}).norm(), 2e-3 * (1.0 + kRounding));
}

}  // namespace
}  // namespace eyeslam::servo
