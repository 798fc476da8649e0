// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/retina/turn_between.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace eyeslam::retina {
namespace {

TEST(TurnBetween, TakesOneDirectionToTheOtherByTheShortestWay)
{
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d from = any(), to = any();
    const Eigen::Quaterniond turn = turnBetween(from, to);
    EXPECT_NEAR(turn.norm(), 1.0, 1e-12);
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-9);
    const double angle = std::acos(std::clamp(from.normalized().dot(to.normalized()), -1.0, 1.0));
    EXPECT_NEAR(Eigen::AngleAxisd(turn).angle(), angle, 1e-6);
  }
}

TEST(TurnBetween, IsHalfATurnBetweenOpposites)
{
  const Eigen::Vector3d from(1.0, -2.0, 0.5);
  const Eigen::Quaterniond turn = turnBetween(from, -3.0 * from);
  EXPECT_LT((turn * from + from).norm(), 1e-9);
  EXPECT_NEAR(turn.norm(), 1.0, 1e-12);
}

}  // namespace
}  // namespace eyeslam::retina
