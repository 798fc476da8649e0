// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/centerline_score.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "eyeslam/fixtures/vessel_graph.h"

namespace eyeslam::files {
namespace {

/// A straight vessel of 9 px, 200 px long, 4 px below the middle of the picture; the map frame begins elsewhere.
KnownVessels bar()
{
  KnownVessels known{cv::Mat_<std::uint8_t>(101, 300, std::uint8_t{0}), {-30.0, 10.0, 1.0}, {}};
  known.vessels(cv::Rect(50, 50, 200, 9)) = 1;
  return known;
}

fixtures::Vessel line(double y_px, double from_px, double to_px)
{
  fixtures::Vessel vessel;
  for (double x = from_px; x <= to_px; x += 1.0) {
    fixtures::CenterlinePoint point;
    point.position_px = {x, y_px};
    point.radius_px = 4.5;
    point.s_px = x - from_px;
    vessel.points.push_back(point);
  }
  return vessel;
}

TEST(CenterlineScore, OfTheMiddleLineIsPerfect)
{
  const CenterlineScore score = scoreCenterlines({line(64.0, 25.0, 215.0)}, bar(), 2.0);
  EXPECT_GT(score.recall, 0.99);
  EXPECT_GT(score.precision, 0.99);
  EXPECT_NEAR(score.radius_error_px, 0.0, 0.01);
}

TEST(CenterlineScore, CountsHalfAVesselAndALineBesideIt)
{
  const CenterlineScore score = scoreCenterlines({line(64.0, 20.0, 119.0), line(80.0, 20.0, 119.0)}, bar(), 2.0);
  EXPECT_NEAR(score.recall, 0.5, 0.03);
  EXPECT_NEAR(score.precision, 0.5, 0.03);
}

TEST(CenterlineScore, AsksOnlyForVesselsThatAreCovered)
{
  KnownVessels known = bar();
  known.covered = cv::Mat_<std::uint8_t>(known.vessels.size(), std::uint8_t{0});
  known.covered(cv::Rect(0, 0, 145, 101)) = 1;
  EXPECT_GT(scoreCenterlines({line(64.0, 20.0, 119.0)}, known, 2.0).recall, 0.98);
}

TEST(CenterlineScore, RefusesNothingToCompareWith)
{
  KnownVessels known = bar();
  known.covered = cv::Mat_<std::uint8_t>(3, 3, std::uint8_t{0});
  EXPECT_THROW(scoreCenterlines({}, known, 2.0), std::invalid_argument);
  known = bar();
  known.vessels = 0;
  EXPECT_THROW(scoreCenterlines({}, known, 2.0), std::invalid_argument);
}

// The photographs' masks, drawn by hand: what issue 14 asks of the graph.
TEST(CenterlineScore, OfHandDrawnMasksIsAtLeast95PercentWithin2Px)
{
  const char* shared = std::getenv("EYESLAM_SHARED");
  const std::filesystem::path folder = std::filesystem::path(shared ? shared : "") / "photographs";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no photographs: " << folder;
  int judged = 0;
  for (const std::string name : {"01_h", "07_g"}) {  // two of eight: all are in scripts/results.py
    const cv::Mat mask = cv::imread((folder / (name + "_vessels.png")).string(), cv::IMREAD_GRAYSCALE);
    if (mask.empty()) continue;
    ++judged;
    retina::VesselMap map;
    map.width = mask.cols;
    map.height = mask.rows;
    map.probability.assign(mask.datastart, mask.dataend);
    fixtures::VesselGraph graph;
    graph.update(map);
    const CenterlineScore score = scoreCenterlines(graph.vessels(), {mask, {0.0, 0.0, 1.0}, {}}, 2.0);
    EXPECT_GE(score.recall, 0.95) << name;
    EXPECT_GE(score.precision, 0.95) << name;
    EXPECT_LE(score.radius_error_px, 1.0) << name;
  }
  EXPECT_GT(judged, 0);
}

}  // namespace
}  // namespace eyeslam::files
