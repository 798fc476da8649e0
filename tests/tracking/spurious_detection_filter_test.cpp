// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/spurious_detection_filter.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "eyeslam/tracking/vessel_tracer.h"
#include "support/allocation_counter.h"
#include "support/drawn_retina.h"

namespace eyeslam::tracking {
namespace {

using support::arc;
using support::DrawnRetina;
using support::PreparedFrame;

// One point on every tenth pixel, all running in one direction.
VesselPoints everywhere(const PreparedFrame& prepared, double direction)
{
  VesselPoints points;
  for (int y = 5; y < prepared.frame.height(); y += 10)
    for (int x = 5; x < prepared.frame.width(); x += 10)
      points.push_back({static_cast<float>(x), static_cast<float>(y), 0.1F, static_cast<float>(direction), 3.0F});
  return points;
}

VesselPoints survivors(const PreparedFrame& prepared, double direction,
                       const SpuriousDetectionFilterOptions& options = {})
{
  VesselPoints points = everywhere(prepared, direction);
  SpuriousDetectionFilter(options).removeFrom(points, prepared.frame, prepared.mask);
  return points;
}

double nearest(const VesselPoints& points, const Eigen::Vector2d& place)
{
  double distance = 1e9;
  for (const VesselPoint& point : points)
    distance = std::min(distance, std::hypot(point.x - place.x(), point.y - place.y()));
  return distance;
}

// Bloom, shaft with shadow and rim, and nothing else; noise as of a camera.
PreparedFrame traps()
{
  DrawnRetina retina(400, 304);
  retina.bloom({110, 100}, 6.0);
  retina.bloom({160, 220}, 3.0);
  retina.shaft({230, 150}, 0.3, 9.0);
  retina.rim({200, 152}, 170.0);
  return PreparedFrame(retina.photograph(1.5, 1));
}

TEST(SpuriousDetectionFilter, LeavesNothingOfBloomShaftEdgeAndRim)
{
  const PreparedFrame prepared = traps();
  VesselPoints points;
  VesselTracer().detect(prepared.frame, prepared.mask, points);
  SpuriousDetectionFilter().removeFrom(points, prepared.frame, prepared.mask);
  const Eigen::Vector2d shaft(std::cos(0.3), std::sin(0.3));
  for (const VesselPoint& point : points) {
    const Eigen::Vector2d at(point.x, point.y);
    const Eigen::Vector2d from_tip = at - Eigen::Vector2d(230, 150);
    const double beside = std::abs(shaft.x() * from_tip.y() - shaft.y() * from_tip.x());
    EXPECT_GT((at - Eigen::Vector2d(110, 100)).norm(), 24.0) << "bloom";
    EXPECT_GT((at - Eigen::Vector2d(160, 220)).norm(), 12.0) << "small bloom";
    EXPECT_LT((at - Eigen::Vector2d(200, 152)).norm(), 160.0) << "rim";
    EXPECT_TRUE(from_tip.dot(shaft) < -4.0 || beside > 20.0) << "shaft or its shadow at " << at.transpose();
  }
  EXPECT_LT(points.size(), 60U) << "nothing here is a vessel";
}

TEST(SpuriousDetectionFilter, KeepsAVesselInPlainView)
{
  DrawnRetina retina(400, 304);
  retina.vessel(arc({200, 152}, 0.3, 0.003, 200), 5.0, 0.25);
  const PreparedFrame prepared(retina.photograph(1.5, 1));
  VesselPoints points;
  VesselTracer().detect(prepared.frame, prepared.mask, points);
  const std::size_t found = points.size();
  SpuriousDetectionFilter().removeFrom(points, prepared.frame, prepared.mask);
  EXPECT_GT(found, 60U);
  EXPECT_EQ(points.size(), found);
}

TEST(SpuriousDetectionFilter, RemovesWhatIsTooDarkOrNotRedEnough)
{
  cv::Mat photo(304, 400, CV_8UC3, cv::Scalar(30, 80, 180));
  cv::rectangle(photo, {200, 0, 60, 304}, cv::Scalar(14, 38, 68), cv::FILLED);    // 0.38 of the red
  cv::rectangle(photo, {320, 0, 60, 304}, cv::Scalar(60, 170, 150), cv::FILLED);  // green
  const PreparedFrame prepared(photo);
  VesselPoints points = everywhere(prepared, 0.0);
  const std::size_t all = points.size();
  const auto removed = SpuriousDetectionFilter().removeFrom(points, prepared.frame, prepared.mask);
  EXPECT_GT(removed.colour, 0);
  EXPECT_EQ(points.size() + static_cast<std::size_t>(removed.colour), all);
  EXPECT_GT(nearest(points, {115, 75}), 14.0);
  EXPECT_GT(nearest(points, {175, 75}), 14.0);
  EXPECT_LT(nearest(points, {50, 75}), 8.0);
  EXPECT_LT(nearest(points, {145, 75}), 8.0);

  SpuriousDetectionFilterOptions lax;
  lax.darkest_red = 0.2;
  EXPECT_LT(nearest(survivors(prepared, 0.0, lax), {115, 75}), 8.0);
  lax.least_redness = 0.2;
  EXPECT_LT(nearest(survivors(prepared, 0.0, lax), {175, 75}), 8.0);
}

TEST(SpuriousDetectionFilter, RemovesWhatIsNearABloom)
{
  DrawnRetina retina(200, 152);
  retina.bloom({100, 76}, 6.0);
  const PreparedFrame prepared(retina.photograph(0.0, 1));
  SpuriousDetectionFilterOptions options;
  options.instrument_distance_cells = 0;
  options.bloom_distance_cells = 6;
  const double wide = nearest(survivors(prepared, 0.0, options), {100, 76});
  options.bloom_distance_cells = 2;
  const double narrow = nearest(survivors(prepared, 0.0, options), {100, 76});
  EXPECT_GT(narrow, 12.0);
  EXPECT_GT(wide, narrow + 8.0);
  options.bloom_whiteness = 1.0;  // nothing is so white
  EXPECT_LT(nearest(survivors(prepared, 0.0, options), {100, 76}), narrow);
}

TEST(SpuriousDetectionFilter, RemovesWhatIsNearTheRim)
{
  DrawnRetina retina(200, 152);
  retina.rim({100, 76}, 60.0);
  const PreparedFrame prepared(retina.photograph(0.0, 1));
  const auto farthest = [&](int cells) {
    SpuriousDetectionFilterOptions options;
    options.rim_distance_cells = cells;
    double distance = 0.0;
    for (const VesselPoint& point : survivors(prepared, 0.0, options))
      distance = std::max(distance, std::hypot(point.x - 100.0, point.y - 76.0));
    return distance;
  };
  EXPECT_LT(farthest(1), 60.0);
  EXPECT_LT(farthest(4), farthest(1) - 8.0);
}

TEST(SpuriousDetectionFilter, RemovesLinesAlongTheShaftButNotAcross)
{
  DrawnRetina retina(200, 152);
  retina.shaft({40, 76}, 0.0, 6.0);
  const PreparedFrame prepared(retina.photograph(0.0, 1));
  const Eigen::Vector2d beside(115, 95);  // 13 px below the edge, outside the mask
  SpuriousDetectionFilterOptions options;
  EXPECT_GT(nearest(survivors(prepared, 0.0, options), beside), 9.0);
  EXPECT_LT(nearest(survivors(prepared, CV_PI / 2, options), beside), 9.0);
  options.instrument_angle_deg = 0.0;
  EXPECT_LT(nearest(survivors(prepared, 0.0, options), beside), 9.0);
  options.instrument_angle_deg = 30.0;
  options.instrument_distance_cells = 1;
  EXPECT_LT(nearest(survivors(prepared, 0.0, options), beside), 9.0);
}

TEST(SpuriousDetectionFilter, HasNoColourTestForAGreyPicture)
{
  const PreparedFrame prepared(cv::Mat(304, 400, CV_8UC1, cv::Scalar(120)));
  EXPECT_EQ(survivors(prepared, 0.0).size(), everywhere(prepared, 0.0).size());
}

TEST(SpuriousDetectionFilter, AllocatesNothingAfterTheFirstFrame)
{
  const PreparedFrame prepared = traps();
  SpuriousDetectionFilter filter;
  VesselPoints points = everywhere(prepared, 0.0);
  filter.removeFrom(points, prepared.frame, prepared.mask);
  const std::int64_t before = support::allocations();
  filter.removeFrom(points, prepared.frame, prepared.mask);
  EXPECT_EQ(support::allocations(), before);
}

}  // namespace
}  // namespace eyeslam::tracking
