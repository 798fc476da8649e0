// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/pose_uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

namespace eyeslam::tracking {
namespace {

const cv::Size kFrame(400, 304);

Eigen::Matrix3d randomCovariance(std::mt19937& random)
{
  std::normal_distribution<double> value(0.0, 0.05);
  Eigen::Matrix3d root;
  for (double& entry : root.reshaped()) entry = value(random);
  return root * root.transpose() + 1e-8 * Eigen::Matrix3d::Identity();
}

TEST(PoseUncertainty, IsTheMosaicsShareAtFrame0WithoutNoise)
{
  const Eigen::Matrix3d refined = Eigen::Vector3d(0.01, 0.02, 1e-6).asDiagonal();
  PoseUncertaintyOptions options;
  options.mosaic_share = 5.0;
  EXPECT_TRUE(honestCovariance(refined, 1.0, {}, kFrame, options).isApprox(5.0 * refined, 1e-12));
}

TEST(PoseUncertainty, GrowsWithTheDistanceFromFrame0AsItsOptionSays)
{
  const Eigen::Matrix3d refined = Eigen::Vector3d(0.01, 0.02, 1e-6).asDiagonal();
  const PoseUncertaintyOptions options;
  const Eigen::Matrix3d near = honestCovariance(refined, 1.0, {}, kFrame, options);
  double last = near(0, 0);
  for (const double distance : {50.0, 100.0, 200.0, 400.0}) {
    for (const retina::Pose2& pose : {retina::Pose2{distance, 0.0}, retina::Pose2{0.0, -distance, 0.3}}) {
      const Eigen::Matrix3d far = honestCovariance(refined, 1.0, pose, kFrame, options);
      EXPECT_NEAR(far(0, 0) / near(0, 0), 1.0 + options.distance_growth * std::pow(distance / 400.0, 2), 1e-9);
    }
    const double now = honestCovariance(refined, 1.0, {distance, 0.0}, kFrame, options)(0, 0);
    EXPECT_GT(now, last);
    last = now;
  }
}

TEST(PoseUncertainty, GrowsWithTheShareOfNoise)
{
  const Eigen::Matrix3d refined = Eigen::Vector3d(0.01, 0.02, 1e-6).asDiagonal();
  const PoseUncertaintyOptions options;
  double last = 0.0;
  for (const double ncc : {1.0, 0.95, 0.8, 0.6, 0.4}) {
    const Eigen::Matrix3d now = honestCovariance(refined, ncc, {}, kFrame, options);
    EXPECT_GT(now(2, 2), last) << ncc;
    last = now(2, 2);
  }
  // Half of the power is noise: 1 + 11 / 4 times.
  EXPECT_NEAR(honestCovariance(refined, std::sqrt(0.5), {}, kFrame, options)(1, 1) / (0.02 * options.mosaic_share),
              1.0 + options.noise_growth / 4.0, 1e-9);
}

TEST(PoseUncertainty, StaysACovarianceAndIsNeverLessThanWhatTheRefinementKnows)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-2000.0, 2000.0), ncc(0.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Matrix3d refined = randomCovariance(random);
    const Eigen::Matrix3d honest =
        honestCovariance(refined, ncc(random), {place(random), place(random)}, kFrame, PoseUncertaintyOptions());
    ASSERT_TRUE(honest.isApprox(honest.transpose(), 1e-12));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> values(honest), excess(Eigen::Matrix3d(honest - refined));
    ASSERT_GT(values.eigenvalues().minCoeff(), 0.0);
    ASSERT_GT(excess.eigenvalues().minCoeff(), 0.0);
  }
}

}  // namespace
}  // namespace eyeslam::tracking
