// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/vessel_tracer.h"

#include <gtest/gtest.h>

#include <functional>

#include "eyeslam/tracking/cross_vessel_smoother.h"
#include "support/allocation_counter.h"
#include "support/drawn_retina.h"

namespace eyeslam::tracking {
namespace {

using support::arc;
using support::Centreline;
using support::DrawnRetina;
using support::PreparedFrame;

constexpr int kWidth = 200;
constexpr int kHeight = 152;
constexpr double kNoise = 1.5;  // grey levels, as a microscope's camera has

struct Vessel {
  double width_px;
  double angle;
  double curvature;
};

std::vector<Vessel> vessels()
{
  std::vector<Vessel> all;
  for (const double width : {2.0, 3.0, 5.0, 8.0, 12.0})
    for (int degrees = 0; degrees < 180; degrees += 15)
      for (const double curvature : {0.0, 1.0 / 50.0}) all.push_back({width, degrees * CV_PI / 180.0, curvature});
  return all;
}

Centreline lineOf(const Vessel& vessel) { return arc({99.3, 76.6}, vessel.angle, vessel.curvature, 110.0); }

PreparedFrame pictureOf(const Vessel& vessel)
{
  DrawnRetina retina(kWidth, kHeight);
  retina.vessel(lineOf(vessel), vessel.width_px, 0.25);
  return PreparedFrame(retina.photograph(kNoise, 7));
}

VesselPoints trace(const PreparedFrame& prepared, const VesselTracerOptions& options = {})
{
  VesselPoints points;
  VesselTracer(options).detect(prepared.frame, prepared.mask, points);
  return points;
}

// Two branching vessels and some noise, for what does not depend on the place.
PreparedFrame fork()
{
  DrawnRetina retina(kWidth, kHeight);
  retina.vessel(arc({100, 76}, 0.3, 0.005, 180), 6.0, 0.25);
  retina.vessel(arc({100, 60}, 1.4, 0.01, 100), 3.0, 0.15);
  return PreparedFrame(retina.photograph(kNoise, 3));
}

class VesselTracerOnOneVessel : public testing::TestWithParam<Vessel> {};

TEST_P(VesselTracerOnOneVessel, StaysWithinOnePixelOfItsCentreline)
{
  const PreparedFrame prepared = pictureOf(GetParam());
  VesselPoints points = trace(prepared);
  CrossVesselSmoother().smoothAcross(points, prepared.frame, prepared.mask);  // as the paper: templates are coarse
  ASSERT_FALSE(points.empty());
  const Centreline line = lineOf(GetParam());
  int far = 0;
  for (const VesselPoint& point : points) {
    // Around its blunt end a vessel has an edge that runs across; where a trace turns there is no error.
    const Eigen::Vector2d at(point.x, point.y);
    if (std::min((at - line.front()).norm(), (at - line.back()).norm()) < GetParam().width_px + 3.0) continue;
    far += support::distanceTo(line, point.x, point.y) > 1.0;
  }
  EXPECT_EQ(far, 0) << "of " << points.size();
}

TEST_P(VesselTracerOnOneVessel, FollowsNearlyItsWholeLength)
{
  const Centreline line = lineOf(GetParam());
  const VesselPoints points = trace(pictureOf(GetParam()));
  constexpr double kGap = 3.0;  // a little more than a step
  int covered = 0;
  for (const Eigen::Vector2d& place : line) {
    covered += std::any_of(points.begin(), points.end(), [&](const VesselPoint& point) {
      return std::hypot(point.x - place.x(), point.y - place.y()) < kGap;
    });
  }
  EXPECT_GE(covered, static_cast<int>(0.92 * static_cast<double>(line.size())));
}

TEST_P(VesselTracerOnOneVessel, MeasuresItsCalibreAndDirection)
{
  const Vessel vessel = GetParam();
  const Centreline line = lineOf(vessel);
  std::vector<double> calibres, turns;
  for (const VesselPoint& point : trace(pictureOf(vessel))) {
    calibres.push_back(point.calibre);
    const auto nearest = std::min_element(line.begin() + 1, line.end() - 1, [&](const auto& a, const auto& b) {
      return (a - Eigen::Vector2d(point.x, point.y)).norm() < (b - Eigen::Vector2d(point.x, point.y)).norm();
    });
    const Eigen::Vector2d tangent = (*(nearest + 1) - *(nearest - 1)).normalized();
    turns.push_back(std::abs(tangent.x() * std::sin(point.direction) - tangent.y() * std::cos(point.direction)));
  }
  ASSERT_FALSE(calibres.empty());
  const auto middle = [](std::vector<double>& values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
  };
  EXPECT_NEAR(middle(calibres), vessel.width_px, 1.5);  // edges are found to whole px on both sides
  EXPECT_LT(middle(turns), std::sin(10.0 * CV_PI / 180.0));
}

INSTANTIATE_TEST_SUITE_P(WidthsAnglesCurvatures, VesselTracerOnOneVessel, testing::ValuesIn(vessels()));

TEST(VesselTracer, FindsHardlyAnythingInNoise)
{
  for (unsigned seed = 0; seed < 5; ++seed) {
    const PreparedFrame prepared(DrawnRetina(400, 304).photograph(4.0, seed));
    EXPECT_LT(trace(prepared).size(), 100U) << "of some 1500 in a view of vessels";
  }
}

TEST(VesselTracer, PutsNoPointOnAMaskedCell)
{
  DrawnRetina retina(kWidth, kHeight);
  retina.vessel(arc({100, 76}, 0.0, 0.0, 190), 5.0, 0.25);
  retina.shaft({120, 70}, 0.6, 8.0);
  retina.rim({100, 76}, 70.0);
  const PreparedFrame prepared(retina.photograph(kNoise, 1));
  const VesselPoints points = trace(prepared);
  EXPECT_FALSE(points.empty());
  for (const VesselPoint& point : points) {
    EXPECT_TRUE(
        prepared.mask.isVisible(static_cast<int>(std::lround(point.x)), static_cast<int>(std::lround(point.y))));
  }
}

TEST(VesselTracer, GivesTheSamePointsAgain)
{
  const PreparedFrame prepared = fork();
  VesselTracer tracer;
  VesselPoints first, second;
  tracer.detect(prepared.frame, prepared.mask, first);
  tracer.detect(prepared.frame, prepared.mask, second);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].x, second[i].x);
    EXPECT_EQ(first[i].y, second[i].y);
    EXPECT_EQ(first[i].direction, second[i].direction);
  }
}

TEST(VesselTracer, AllocatesNothingAfterTheFirstFrame)
{
  const PreparedFrame prepared = fork();
  VesselTracer tracer;
  VesselPoints points;
  tracer.detect(prepared.frame, prepared.mask, points);
  const std::int64_t before = support::allocations();
  tracer.detect(prepared.frame, prepared.mask, points);
  EXPECT_EQ(support::allocations(), before);
}

TEST(VesselTracer, LooksAtPicturesOfAnySize)
{
  for (const cv::Size size : {cv::Size(32, 32), cv::Size(64, 48), cv::Size(33, 150), cv::Size(960, 540)}) {
    DrawnRetina retina(size.width, size.height);
    retina.vessel(arc({size.width / 2.0, size.height / 2.0}, 0.4, 0.0, 2.0 * size.width), 3.0, 0.3);
    EXPECT_FALSE(trace(PreparedFrame(retina.photograph(kNoise, 1))).empty()) << size;
  }
}

TEST(VesselTracer, TriesTheStrongestSeedsOfTheWholeViewWhenThereAreTooMany)
{
  DrawnRetina retina(400, 304);
  const Centreline line = arc({200.0, 290.0}, 0.0, 0.0, 360.0);
  retina.vessel(line, 4.0, 0.3);
  VesselTracerOptions options;
  options.grid_pitch_px = 4;
  options.seed_depth = 0.0;  // half of all local minima on the grid: some 10,000, most of them above the vessel
  const VesselPoints points = trace(PreparedFrame(retina.photograph(kNoise, 1)), options);
  const auto on_vessel = std::count_if(points.begin(), points.end(), [&](const VesselPoint& point) {
    return support::distanceTo(line, point.x, point.y) < 3.0;
  });
  EXPECT_GT(on_vessel, 100) << "of 144 steps";
}

TEST(VesselTracer, TurnsWithAVesselThatBendsMoreThanOneStepAtATime)
{
  const Centreline hairpin = arc({100, 76}, 0.0, 1.0 / 7.0, 20.0);  // 22.5 degrees in 2.7 px, about a step
  DrawnRetina retina(kWidth, kHeight);
  Centreline line = hairpin;
  const Eigen::Vector2d out = (hairpin.back() - hairpin[hairpin.size() - 2]).normalized();
  const Eigen::Vector2d in = (hairpin.front() - hairpin[1]).normalized();
  for (double s = 0.5; s < 50.0; s += 0.5) line.push_back(hairpin.back() + s * out);
  for (double s = 0.5; s < 50.0; s += 0.5) line.insert(line.begin(), hairpin.front() + s * in);
  retina.vessel(line, 3.0, 0.3);
  const VesselPoints points = trace(PreparedFrame(retina.photograph(kNoise, 1)));
  int covered = 0;
  for (const Eigen::Vector2d& place : line)
    covered += std::any_of(points.begin(), points.end(), [&](const VesselPoint& point) {
      return std::hypot(point.x - place.x(), point.y - place.y()) < 3.0;
    });
  EXPECT_GE(covered, static_cast<int>(0.9 * static_cast<double>(line.size())));
}

TEST(VesselTracer, FindsLessWhenItsOptionsAreStricter)
{
  const PreparedFrame prepared = fork();
  const std::size_t usual = trace(prepared).size();
  const auto found = [&](const std::function<void(VesselTracerOptions&)>& change) {
    VesselTracerOptions options;
    change(options);
    return trace(prepared, options).size();
  };
  EXPECT_LT(found([](auto& o) { o.seed_depth = 40.0; }), usual);
  EXPECT_LT(found([](auto& o) { o.seed_strength = 60.0; }), usual);
  EXPECT_LT(found([](auto& o) { o.edge_strength = 40.0; }), usual);
  EXPECT_LT(found([](auto& o) { o.lowest_strength = 0.35; }), usual);
  EXPECT_LT(found([](auto& o) { o.weaker_edge = 0.95; }), usual);
  EXPECT_LT(found([](auto& o) { o.fading = 1.0; }), usual);
  EXPECT_LT(found([](auto& o) { o.step_px = 5.0; }), usual);
  EXPECT_LT(found([](auto& o) { o.shortest_trace = 60; }), usual);
  EXPECT_LT(found([](auto& o) { o.grid_pitch_px = 64, o.seed_depth = 4.0; }), usual);
  EXPECT_EQ(found([](auto& o) { o.most_points = 40; }), 40U);
}

}  // namespace
}  // namespace eyeslam::tracking
