// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/pose_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "support/allocation_counter.h"

using namespace eyeslam;
using namespace eyeslam::tracking;
using eyeslam::retina::Pose2;

namespace {

constexpr double kRounding = 1e-9;

PoseEstimate measurement(const Pose2& pose, double sigma_px, double sigma_rad)
{
  const Eigen::Vector3d sigma(sigma_px, sigma_px, sigma_rad);
  return {pose, sigma.cwiseAbs2().asDiagonal()};
}

void expectCovariance(const Eigen::Matrix3d& covariance)
{
  ASSERT_TRUE(covariance.allFinite());
  EXPECT_EQ(covariance, covariance.transpose());
  // In units of its own sigmas, so that the eigenvalues of px and rad compare.
  const Eigen::Vector3d sigma = covariance.diagonal().cwiseSqrt();
  const Eigen::Matrix3d scaled = sigma.cwiseInverse().asDiagonal() * covariance * sigma.cwiseInverse().asDiagonal();
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scaled).eigenvalues()(0), 0.0);
}

TEST(PoseFilter, FollowsAJumpWithoutLag)
{
  PoseFilter filter;
  filter.reset(measurement({}, 0.1, 0.001));
  for (int i = 0; i < 20; ++i) {
    filter.predict(1.0);
    filter.correct(measurement({i * 2.0, 0.0, 0.0, 1.0}, 0.1, 0.001));
  }
  filter.predict(1.0);
  const Pose2 landed{400.0, -90.0, 0.12, 1.02};
  const PoseEstimate found = filter.correct(measurement(landed, 0.1, 0.001));
  EXPECT_TRUE(filter.jumped());
  EXPECT_EQ(found.map_T_frame.x, landed.x);
  EXPECT_EQ(found.map_T_frame.y, landed.y);
  EXPECT_EQ(found.map_T_frame.theta, landed.theta);
  EXPECT_EQ(found.map_T_frame.scale, landed.scale);
  EXPECT_EQ(filter.velocity().norm(), 0.0);
  EXPECT_EQ(filter.predict(1.0).map_T_frame.x, landed.x);
}

TEST(PoseFilter, PredictsASteadyMotion)
{
  PoseFilter filter;
  filter.reset(measurement({}, 0.05, 1e-4));
  for (int i = 1; i <= 40; ++i) {
    filter.predict(1.0);
    filter.correct(measurement({3.0 * i, -2.0 * i, 0.002 * i, 1.0}, 0.05, 1e-4));
  }
  const Pose2 next = filter.predict(1.0).map_T_frame;
  EXPECT_NEAR(next.x, 3.0 * 41, 0.02);
  EXPECT_NEAR(next.y, -2.0 * 41, 0.02);
  EXPECT_NEAR(next.theta, 0.002 * 41, 1e-4);
}

TEST(PoseFilter, WeighsAMeasurementByItsCovariance)
{
  // By hand: at rest after reset, one frame on, the prior variance of x is P = r + v + a^2 / 4, with r the start's,
  // v = (3 a)^2 the unknown velocity's, a = 1.5; the gain is P / (P + R).
  PoseFilter filter;
  filter.reset(measurement({}, 1.0, 0.01));
  filter.predict(1.0);
  const double prior = 1.0 + 4.5 * 4.5 + 1.5 * 1.5 / 4.0, noise = 4.0;
  const PoseEstimate found = filter.correct(measurement({5.0, 0.0, 0.0, 1.0}, 2.0, 0.01));
  EXPECT_NEAR(found.map_T_frame.x, 5.0 * prior / (prior + noise), 1e-6);
  EXPECT_NEAR(found.covariance(0, 0), prior * noise / (prior + noise), 1e-6);
}

TEST(PoseFilter, TakesTheShortWayAcrossTheHalfTurn)
{
  PoseFilter filter;
  filter.reset(measurement({0.0, 0.0, M_PI - 0.01, 1.0}, 0.1, 0.001));
  filter.predict(1.0);
  const PoseEstimate found = filter.correct(measurement({0.0, 0.0, -M_PI + 0.01, 1.0}, 0.1, 0.01));
  EXPECT_FALSE(filter.jumped());
  EXPECT_GT(std::abs(found.map_T_frame.theta), M_PI - 0.011);
  EXPECT_LE(std::abs(found.map_T_frame.theta), M_PI);
}

TEST(PoseFilter, RefusesAMeasurementThatIsNotFinite)
{
  for (int field = 0; field < 6; ++field) {
    PoseFilter filter;
    filter.reset(measurement({7.0, 8.0, 0.1, 1.0}, 0.1, 0.001));
    filter.predict(1.0);
    PoseEstimate bad = measurement({7.0, 8.0, 0.1, 1.0}, 0.1, 0.001);
    if (field == 0) bad.map_T_frame.x = NAN;
    if (field == 1) bad.map_T_frame.theta = HUGE_VAL;
    if (field == 2) bad.map_T_frame.scale = 0.0;
    if (field == 3) bad.map_T_frame.scale = NAN;
    if (field == 4) bad.covariance(0, 1) = NAN;
    if (field == 5) bad.covariance(2, 2) = HUGE_VAL;
    const PoseEstimate found = filter.correct(bad);
    EXPECT_NEAR(found.map_T_frame.x, 7.0, kRounding);
    EXPECT_NEAR(found.map_T_frame.theta, 0.1, kRounding);
    EXPECT_EQ(found.map_T_frame.scale, 1.0);
    expectCovariance(found.covariance);
  }
}

TEST(PoseFilter, KeepsItsCovariancePositiveForAnyInput)
{
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-12.0, 12.0), share(0.0, 1.0);
  PoseFilter filter;
  for (int i = 0; i < 20000 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    expectCovariance(filter.predict(share(random) < 0.1 ? std::pow(10.0, exponent(random)) : 1.0).covariance);
    if (share(random) < 0.2) {
      filter.coast();
      continue;
    }
    const double size = std::pow(10.0, exponent(random));
    PoseEstimate any;
    any.map_T_frame = {normal(random) * size, normal(random) * size, normal(random) * 3.0, 1.0 + 0.01 * share(random)};
    any.covariance = std::pow(10.0, exponent(random)) * Eigen::Matrix3d::NullaryExpr([&] { return normal(random); });
    expectCovariance(filter.correct(any).covariance);
    EXPECT_LE(std::abs(filter.estimate().map_T_frame.theta), M_PI);
  }
}

TEST(PoseFilter, GrowsUnsureAndSlowsDownWhileFramesAreRefused)
{
  PoseFilter filter;
  filter.reset(measurement({}, 0.1, 0.001));
  for (int i = 1; i <= 20; ++i) {
    filter.predict(1.0);
    filter.correct(measurement({5.0 * i, 0.0, 0.0, 1.0}, 0.1, 0.001));
  }
  double variance = 0.0, speed = filter.velocity().norm();
  for (int i = 0; i < 10; ++i) {
    const PosePrediction predicted = filter.predict(1.0);
    filter.coast();
    EXPECT_GT(predicted.covariance(0, 0), variance);
    EXPECT_LT(filter.velocity().norm(), speed);
    variance = predicted.covariance(0, 0);
    speed = filter.velocity().norm();
  }
  EXPECT_LT(filter.estimate().map_T_frame.x, 20 * 5.0 + 5.0 / (1.0 - 0.7) + 1.0);  // the sum of the fading steps
}

TEST(PoseFilter, KeepsTheScaleOfAViewThatIsNotMagnified)
{
  PoseFilter filter;
  filter.reset(measurement({}, 0.1, 0.001));
  for (int i = 0; i < 50; ++i) {
    filter.predict(1.0);
    EXPECT_EQ(filter.correct(measurement({}, 0.1, 0.001)).map_T_frame.scale, 1.0);
  }
  for (int i = 0; i < 10; ++i) {
    filter.predict(1.0);
    filter.correct(measurement({0.0, 0.0, 0.0, 1.01}, 0.1, 0.001));
  }
  EXPECT_NEAR(filter.estimate().map_T_frame.scale, 1.01, 1e-4);
}

TEST(PoseFilter, AllocatesNothing)
{
  PoseFilter filter;
  const std::int64_t before = support::allocations();
  for (int i = 0; i < 100; ++i) {
    filter.predict(1.0);
    filter.correct(measurement({1.0 * i, 0.0, 0.0, 1.0}, 0.1, 0.001));
    filter.predict(1.0);
    filter.coast();
  }
  EXPECT_EQ(support::allocations(), before);
}

}  // namespace
