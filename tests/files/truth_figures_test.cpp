// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/truth_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "eyeslam/files/chart.h"

using namespace eyeslam::files;

namespace {

const cv::Size kFigure(1600, 1000);

/// Twelve seconds of slow motion with a blackout of one, over two crossing vessels.
Truth slowMotion()
{
  Truth truth;
  truth.size = {400, 304};
  for (int frame = 0; frame < 360; ++frame) {
    const double t_s = frame / 30.0;
    const bool visible = frame < 150 || frame >= 180;
    truth.poses.push_back(
        {t_s, 40.0 * std::sin(t_s), 25.0 * std::sin(0.7 * t_s), 3.0 * std::sin(0.4 * t_s), 1.0, visible});
  }
  truth.vessels_origin = {-100.0, -100.0};
  truth.vessels = cv::Mat_<std::uint8_t>(504, 600, std::uint8_t{0});
  cv::line(truth.vessels, {0, 100}, {599, 400}, 8, 8);
  cv::line(truth.vessels, {150, 503}, {420, 0}, 5, 5);
  return truth;
}

std::vector<EstimatedPose> nearby(const Truth& truth)
{
  std::vector<EstimatedPose> estimate;
  EstimatedPose last;
  for (const TruthPose& pose : truth.poses) {
    const double wave = 0.1 * std::sin(9.0 * pose.t_s);
    if (pose.visible)
      last = {true, pose.x_px + wave, pose.y_px - wave, pose.theta_deg + 0.02 * wave, 0.8};
    else
      last.tracked = false;
    estimate.push_back(last);
  }
  return estimate;
}

/// The upper vessel up to a length that grows with time, and a stray line.
std::vector<JudgedMap> growingMaps(const Truth& truth)
{
  MapScorer scorer(truth);
  std::vector<JudgedMap> maps;
  for (const int frame : {15, 30, 60, 120, 240, 359}) {
    cv::Mat_<std::uint8_t> cells(252, 300, std::uint8_t{0});
    cv::line(cells, {0, 50}, {frame * 299 / 359, 50 + frame * 150 / 359}, 220, 4);
    cv::line(cells, {200, 60}, {200 + frame / 10, 90}, 200, 2);
    eyeslam::retina::VesselMap map;
    map.width = cells.cols;
    map.height = cells.rows;
    map.origin_x = map.origin_y = -100.0;
    map.px_per_cell = 2.0;
    map.probability.assign(cells.begin(), cells.end());
    const MapScore score = scorer.score(frame, map);
    maps.push_back({score, scorer.verdicts().clone()});
  }
  return maps;
}

int pixelsOf(const cv::Mat& picture, const cv::Scalar& colour)
{
  cv::Mat equal;
  cv::inRange(picture, colour, colour, equal);
  return cv::countNonZero(equal);
}

TEST(Chart, PutsTicksOnRoundNumbers)
{
  EXPECT_EQ(ticks({0.0, 10.0}, 5), (std::vector<double>{0.0, 2.0, 4.0, 6.0, 8.0, 10.0}));
  const auto fine = ticks({-0.031, 0.029}, 6);
  ASSERT_EQ(fine.size(), 6U);
  EXPECT_NEAR(fine.front(), -0.03, 1e-12);
  EXPECT_NEAR(fine.back(), 0.02, 1e-12);
}

TEST(Chart, HoldsAllFiniteValuesAndIsNeverFlat)
{
  const Interval interval = Interval{0.0, 0.0}.holding({1.0, std::nan(""), -3.0}).padded(0.5);
  EXPECT_LT(interval.from, -3.0);
  EXPECT_GT(interval.to, 1.0);
  EXPECT_DOUBLE_EQ((Interval{2.0, 2.0}.padded(0.5).length()), 0.5);
}

TEST(TruthFigures, ShowPoseAndErrorAndShadeTheBlackout)
{
  const Truth truth = slowMotion();
  const cv::Mat figure = poseFigure("slow", truth, nearby(truth));
  EXPECT_EQ(figure.size(), kFigure);
  EXPECT_EQ(figure.type(), CV_8UC3);
  EXPECT_GT(pixelsOf(figure, {190, 90, 20}), 200) << "the estimated curves";
  EXPECT_GT(pixelsOf(figure, {226, 222, 218}), 6 * 30 * 100) << "a stretch of the blackout in each of six charts";
  if (const char* folder = std::getenv("EYESLAM_FIGURES")) cv::imwrite(std::string(folder) + "/pose.png", figure);
}

TEST(TruthFigures, ShowTheMapInTheColoursOfItsVerdicts)
{
  const Truth truth = slowMotion();
  const cv::Mat figure = mapFigure("slow", truth, growingMaps(truth));
  EXPECT_EQ(figure.size(), kFigure);
  EXPECT_GT(pixelsOf(figure, {70, 150, 40}), 1000) << "found";
  EXPECT_GT(pixelsOf(figure, {60, 60, 225}), 100) << "false";
  EXPECT_GT(pixelsOf(figure, {235, 170, 90}), 1000) << "missed";
  if (const char* folder = std::getenv("EYESLAM_FIGURES")) cv::imwrite(std::string(folder) + "/map.png", figure);
}

TEST(TruthFigures, AreDrawnForASingleFrameAndForALostTracker)
{
  Truth truth = slowMotion();
  std::vector<EstimatedPose> lost(truth.poses.size());
  EXPECT_EQ(poseFigure("lost", truth, lost).size(), kFigure);
  truth.poses.resize(1);
  EXPECT_EQ(poseFigure("one", truth, {{true, 0.0, 0.0, 0.0, 1.0}}).size(), kFigure);
}

TEST(TruthFigures, RefuseToShowNoMap) { EXPECT_THROW(mapFigure("none", slowMotion(), {}), std::invalid_argument); }

}  // namespace
