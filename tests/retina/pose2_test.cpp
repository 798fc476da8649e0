// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/retina/pose2.h"

#include <gtest/gtest.h>

#include <random>

using eyeslam::retina::Pose2;
using eyeslam::retina::wrapAngle;

namespace {

Pose2 randomPose(std::mt19937& random)
{
  std::uniform_real_distribution<double> shift(-300.0, 300.0), angle(-3.0, 3.0), scale(0.5, 2.0);
  return {shift(random), shift(random), angle(random), scale(random)};
}

constexpr double kRounding = 1e-9;

TEST(Pose2, MapsTheCentreByItsTranslationAlone)
{
  const Pose2 map_T_frame{3.0, -4.0, 0.7, 1.3};
  const Eigen::Vector2d centre = map_T_frame * Eigen::Vector2d(0.0, 0.0);
  EXPECT_DOUBLE_EQ(centre.x(), 3.0);
  EXPECT_DOUBLE_EQ(centre.y(), -4.0);
}

TEST(Pose2, TurnsXTowardsYForAPositiveAngle)
{
  const Eigen::Vector2d turned = Pose2{0.0, 0.0, M_PI / 2, 1.0} * Eigen::Vector2d(1.0, 0.0);
  EXPECT_NEAR(turned.x(), 0.0, kRounding);
  EXPECT_NEAR(turned.y(), 1.0, kRounding);
}

TEST(Pose2, ComposesAsItsMapsDo)
{
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Pose2 a_T_b = randomPose(random), b_T_c = randomPose(random);
    const Eigen::Vector2d point_c(17.0, -5.0);
    EXPECT_NEAR(((a_T_b * b_T_c) * point_c - a_T_b * (b_T_c * point_c)).norm(), 0.0, kRounding);
  }
}

TEST(Pose2, TimesItsInverseIsTheIdentity)
{
  std::mt19937 random(2);
  for (int i = 0; i < 1000; ++i) {
    const Pose2 a_T_b = randomPose(random);
    const Pose2 identity = a_T_b * a_T_b.inverse();
    EXPECT_NEAR(identity.translation().norm(), 0.0, kRounding);
    EXPECT_NEAR(identity.theta, 0.0, kRounding);
    EXPECT_NEAR(identity.scale, 1.0, kRounding);
  }
}

TEST(Pose2, WrapsAnglesToOneTurn)
{
  for (double theta = -20.0; theta < 20.0; theta += 0.37) {
    const double wrapped = wrapAngle(theta);
    EXPECT_GT(wrapped, -M_PI - kRounding);
    EXPECT_LE(wrapped, M_PI);
    EXPECT_NEAR(std::sin(wrapped), std::sin(theta), kRounding);
    EXPECT_NEAR(std::cos(wrapped), std::cos(theta), kRounding);
  }
}

}  // namespace
