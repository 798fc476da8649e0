// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/spot_aim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace eyeslam::servo;

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000;

Eigen::Vector2d spotOf(const Eigen::Vector3d& tip, const Eigen::Vector3d& shaft)
{
  const Eigen::Vector3d spot = tip - shaft * (tip.z() / shaft.z());
  return spot.head<2>();
}

}  // namespace

TEST(SpotAim, ATipWhereItAsksForItPutsTheSpotOnThePlace)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> way(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d shaft = Eigen::Vector3d(0.6 * way(random), 0.6 * way(random), 1.0).normalized();
    SpotAim aim;
    aim.observe(kStart, {1e-3 * way(random), 1e-3 * way(random), -1e-3}, shaft);
    ASSERT_TRUE(aim.isReady());
    const Eigen::Vector2d place(2e-3 * way(random), 2e-3 * way(random));
    const double standoff = 1e-3 + 0.5e-3 * way(random);
    const Eigen::Vector3d tip = aim.tipFor(place, standoff);
    EXPECT_EQ(tip.z(), -standoff);
    EXPECT_LT((spotOf(tip, shaft) - place).norm(), 1e-9);
  }
}

TEST(SpotAim, SpotsThatAreSeenMoveTheAimAndNotBeyondTheLimit)
{
  for (const auto& [offset, expected] : {std::pair{80e-6, 80e-6}, {250e-6, 150e-6}, {900e-6, 0.0}}) {
    SpotAim aim;
    const Eigen::Vector3d tip(0.0, 0.0, -1e-3), shaft = Eigen::Vector3d(0.5, 0.0, 0.8).normalized();
    for (int i = 0; i < 1000; ++i) {
      const std::int64_t utime = kStart + 1000 * i;
      aim.observe(utime, tip, shaft);
      if (i % 33 == 32) aim.correct(utime - 15'000, spotOf(tip, shaft) + Eigen::Vector2d(offset, 0.0));
    }
    EXPECT_NEAR(aim.correction().x(), expected, 2e-6) << offset;
  }
}

// A tip in motion: the spot of 15 ms ago is compared with the place of 15 ms ago.
TEST(SpotAim, AMovingTipLeavesNoCorrectionBehind)
{
  SpotAim aim;
  const Eigen::Vector3d shaft = Eigen::Vector3d(0.5, 0.0, 0.8).normalized();
  const auto tipAt = [](std::int64_t utime) {
    return Eigen::Vector3d(5e-3 * 1e-6 * static_cast<double>(utime - kStart), 0.0, -1e-3);
  };
  for (int i = 0; i < 500; ++i) {
    const std::int64_t utime = kStart + 1000 * i;
    aim.observe(utime, tipAt(utime), shaft);
    if (i % 33 == 32) aim.correct(utime - 15'000, spotOf(tipAt(utime - 15'000), shaft));
  }
  EXPECT_LT(aim.correction().norm(), 1e-7);
}

TEST(SpotAim, NoiseOfTheShaftIsTakenOffTheGoal)
{
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0.0, 0.005);
  SpotAim aim;
  double squares = 0.0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector3d shaft = Eigen::Vector3d(0.5 + noise(random), noise(random), 0.8).normalized();
    aim.observe(kStart + 1000 * i, {0.0, 0.0, -1e-3}, shaft);
    if (i > 200) squares += (aim.tipFor({0.0, 0.0}, 1e-3).head<2>() + Eigen::Vector2d(0.625e-3, 0.0)).squaredNorm();
  }
  // Unfiltered 0.005 / 0.8 x 1 mm = 6 um an axis; a pole of 20 ms leaves 1 / sqrt(40) of it.
  EXPECT_LT(std::sqrt(squares / kSteps), 2.5e-6);
}

TEST(SpotAim, IgnoresWhatIsNoNumberNotLaterOrAlongTheRetina)
{
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  SpotAim aim;
  aim.observe(kStart, {kNaN, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  aim.observe(kStart, {0.0, 0.0, -1e-3}, {kNaN, 0.0, 1.0});
  aim.observe(kStart, {0.0, 0.0, -1e-3}, Eigen::Vector3d::UnitX());
  aim.observe(kStart, {0.0, 0.0, -1e-3}, -Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(aim.isReady());
  aim.observe(kStart, {0.0, 0.0, -1e-3}, Eigen::Vector3d::UnitZ());
  aim.observe(kStart, {1.0, 0.0, -1e-3}, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(aim.spot().x(), 0.0);
  EXPECT_FALSE(aim.correct(kStart, {kNaN, 0.0}));
  EXPECT_FALSE(aim.correct(kStart + 5000, {0.0, 0.0}));  // from the future
}
