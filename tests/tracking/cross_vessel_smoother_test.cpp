// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/cross_vessel_smoother.h"

#include <gtest/gtest.h>

#include "support/allocation_counter.h"
#include "support/drawn_retina.h"

namespace eyeslam::tracking {
namespace {

using support::arc;
using support::DrawnRetina;
using support::PreparedFrame;

constexpr double kAngle = 0.4;

PreparedFrame straightVessel(double width_px, double noise)
{
  DrawnRetina retina(200, 152);
  retina.vessel(arc({99.3, 76.6}, kAngle, 0.0, 150.0), width_px, 0.25);
  return PreparedFrame(retina.photograph(noise, 5));
}

// Along the vessel, `off` px beside its centreline.
VesselPoints pointsBeside(double off, double width_px)
{
  VesselPoints points;
  const Eigen::Vector2d along(std::cos(kAngle), std::sin(kAngle));
  const Eigen::Vector2d across(-along.y(), along.x());
  for (double s = -50.0; s <= 50.0; s += 2.5) {
    const Eigen::Vector2d at = Eigen::Vector2d(99.3, 76.6) + s * along + off * across;
    points.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()), 0.1F, static_cast<float>(kAngle),
                      static_cast<float>(width_px)});
  }
  return points;
}

double rmsDistance(const VesselPoints& points)
{
  double sum = 0.0;
  for (const VesselPoint& point : points) {
    const double across = -(point.x - 99.3) * std::sin(kAngle) + (point.y - 76.6) * std::cos(kAngle);
    sum += across * across;
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(CrossVesselSmoother, BringsPointsToAFractionOfAPixelFromTheCentreline)
{
  for (const double width : {2.0, 3.0, 5.0, 8.0, 12.0}) {
    const PreparedFrame prepared = straightVessel(width, 1.5);
    for (const double off : {-1.7, -0.8, 0.0, 0.5, 1.9}) {
      VesselPoints points = pointsBeside(off, width);
      CrossVesselSmoother().smoothAcross(points, prepared.frame, prepared.mask);
      EXPECT_LT(rmsDistance(points), 0.3) << width << " px wide, " << off << " px off";
    }
  }
}

TEST(CrossVesselSmoother, IsExactToATwentiethOfAPixelWithoutNoise)
{
  const PreparedFrame prepared = straightVessel(5.0, 0.0);
  VesselPoints points = pointsBeside(1.3, 5.0);
  CrossVesselSmoother().smoothAcross(points, prepared.frame, prepared.mask);
  EXPECT_LT(rmsDistance(points), 0.06);  // the parabola's and the interpolation's share, and 8-bit rounding
}

TEST(CrossVesselSmoother, LeavesAPointThatHasNoVesselWithinReach)
{
  const PreparedFrame prepared = straightVessel(3.0, 0.0);
  const VesselPoints before = pointsBeside(6.0, 3.0);
  VesselPoints after = before;
  CrossVesselSmoother().smoothAcross(after, prepared.frame, prepared.mask);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i].x, before[i].x, 2.0);
  EXPECT_GT(rmsDistance(after), 3.0);
}

TEST(CrossVesselSmoother, ReachesOnlyAsFarAsItsOptionSays)
{
  const PreparedFrame prepared = straightVessel(3.0, 0.0);
  VesselPoints far = pointsBeside(3.5, 3.0);
  VesselPoints near = far;
  CrossVesselSmootherOptions options;
  options.reach_px = 5;
  CrossVesselSmoother(options).smoothAcross(far, prepared.frame, prepared.mask);
  options.reach_px = 2;
  CrossVesselSmoother(options).smoothAcross(near, prepared.frame, prepared.mask);
  EXPECT_LT(rmsDistance(far), 0.3);
  EXPECT_GT(rmsDistance(near), 1.0);
}

TEST(CrossVesselSmoother, AveragesNoiseAlongAndAcross)
{
  const PreparedFrame prepared = straightVessel(4.0, 6.0);
  const auto error = [&](double width_share, int along_px) {
    CrossVesselSmootherOptions options;
    options.width_share = width_share;
    options.along_px = along_px;
    VesselPoints points = pointsBeside(1.0, 4.0);
    CrossVesselSmoother(options).smoothAcross(points, prepared.frame, prepared.mask);
    return rmsDistance(points);
  };
  EXPECT_LT(error(1.0, 2), error(1.0, 0));
  EXPECT_LT(error(1.2, 2), error(0.2, 2));
}

TEST(CrossVesselSmoother, AllocatesNothing)
{
  const PreparedFrame prepared = straightVessel(4.0, 1.0);
  VesselPoints points = pointsBeside(1.0, 4.0);
  const CrossVesselSmoother smoother;
  const std::int64_t before = support::allocations();
  smoother.smoothAcross(points, prepared.frame, prepared.mask);
  EXPECT_EQ(support::allocations(), before);
}

}  // namespace
}  // namespace eyeslam::tracking
