// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/surface_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

using namespace eyeslam;
using eyeslam::retina::Reason;
using eyeslam::servo::fitSurface;
using eyeslam::servo::SurfaceFit;

namespace {

/// Points of a tilted plane over `extent` m, with noise across it.
std::vector<Eigen::Vector3d> sweep(unsigned seed, int count, double extent, double noise,
                                   const Eigen::Vector3d& normal = Eigen::Vector3d(0.15, -0.1, -1.0).normalized())
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> across(-extent, extent);
  std::normal_distribution<double> unit(0.0, 1.0);  // scaled, because a deviation of 0 is not allowed
  const Eigen::Vector3d first = normal.unitOrthogonal();
  const Eigen::Vector3d second = normal.cross(first);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double u = across(random);
    const double v = across(random);
    points.emplace_back(u * first + v * second + (2e-3 + noise * unit(random)) * normal);
  }
  return points;
}

const Eigen::Vector3d kNormal = Eigen::Vector3d(0.15, -0.1, -1.0).normalized();
const Eigen::Vector3d kInstrument = 8e-3 * kNormal;

TEST(SurfaceFit, FindsTheHeightUnderTheSweepWithinItsNoise)
{
  for (unsigned seed = 0; seed < 50; ++seed) {
    const SurfaceFit fit = fitSurface(sweep(seed, 300, 1.5e-3, 30e-6), kInstrument);
    ASSERT_EQ(fit.reason, Reason::none);
    const Eigen::Vector3d middle = 2e-3 * kNormal;
    EXPECT_NEAR(fit.plane.height(middle), 0.0, 8e-6) << "30 um / sqrt(300), four sigma";
    EXPECT_GT(fit.plane.normal.dot(kNormal), std::cos(0.01));
    EXPECT_NEAR(fit.plane.residual, 30e-6, 8e-6);
  }
}

TEST(SurfaceFit, AThirdOfWrongPointsDoesNoHarm)
{
  std::vector<Eigen::Vector3d> points = sweep(1, 300, 1.5e-3, 20e-6);
  for (std::size_t i = 0; i < points.size(); i += 3) points[i] += 4e-4 * (1.0 + static_cast<double>(i % 7)) * kNormal;
  const SurfaceFit fit = fitSurface(points, kInstrument);
  EXPECT_EQ(fit.reason, Reason::none);
  EXPECT_NEAR(fit.plane.height(2e-3 * kNormal), 0.0, 10e-6);
  EXPECT_NEAR(fit.used, 200, 8);
}

TEST(SurfaceFit, TheNormalPointsToTheInstrument)
{
  const std::vector<Eigen::Vector3d> points = sweep(2, 100, 1e-3, 1e-6);
  EXPECT_GT(fitSurface(points, kInstrument).plane.height(kInstrument), 0.0);
  EXPECT_GT(fitSurface(points, -kInstrument).plane.height(-kInstrument), 0.0);
}

TEST(SurfaceFit, ExactPointsGiveTheExactPlane)
{
  const SurfaceFit fit = fitSurface(sweep(3, 50, 1e-3, 0.0), kInstrument);
  EXPECT_EQ(fit.reason, Reason::none);
  EXPECT_LT(fit.plane.residual, 1e-12);
  EXPECT_NEAR(fit.plane.distance, 2e-3, 1e-12);
}

TEST(SurfaceFit, RefusesALineACloudAndTooFewPoints)
{
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < 200; ++i) line.emplace_back(1e-5 * i, 0.0, 0.0);
  EXPECT_EQ(fitSurface(line, kInstrument).reason, Reason::surface_unknown);
  EXPECT_EQ(fitSurface(sweep(4, 300, 1e-3, 3e-4), kInstrument).reason, Reason::surface_unknown);
  EXPECT_EQ(fitSurface(sweep(5, 5, 1e-3, 0.0), kInstrument).reason, Reason::surface_unknown);
  EXPECT_EQ(fitSurface({}, kInstrument).reason, Reason::surface_unknown);
}

TEST(SurfaceFit, PointsThatAreNotFiniteAreLeftOut)
{
  std::vector<Eigen::Vector3d> points = sweep(6, 100, 1e-3, 5e-6);
  points[3].x() = NAN;
  points[50].z() = INFINITY;
  EXPECT_EQ(fitSurface(points, kInstrument).reason, Reason::none);
}

}  // namespace
