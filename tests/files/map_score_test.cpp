// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/map_score.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "eyeslam/files/thinning.h"

using eyeslam::files::MapScore;
using eyeslam::files::MapScorer;
using eyeslam::files::MapVerdict;
using eyeslam::files::Truth;
using eyeslam::retina::VesselMap;

namespace {

/// 12 frames of 200 x 100 px at rest, a vessel of 7 px from (0, 50) to (199, 50) whose picture begins at (-10, -20).
Truth straightVessel()
{
  Truth truth;
  truth.size = {200, 100};
  truth.poses.resize(12);
  truth.vessels_origin = {-10.0, -20.0};
  truth.vessels = cv::Mat_<std::uint8_t>(140, 220, std::uint8_t{0});
  cv::rectangle(truth.vessels, {10, 67}, {209, 73}, 7, -1);
  return truth;
}

/// A map of cells of 2 px whose vessels are the map px of `band`.
VesselMap mapOf(cv::Rect band)
{
  VesselMap map;
  map.width = 100;
  map.height = 50;
  map.px_per_cell = 2.0;
  map.probability.assign(5000, 0);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (band.contains({2 * column, 2 * row})) map.probability[map.index(column, row)] = 200;
    }
  }
  return map;
}

TEST(MapScore, IsFullForTheVesselItself)
{
  MapScorer scorer(straightVessel());
  const MapScore score = scorer.score(11, mapOf({0, 48, 200, 4}));
  EXPECT_DOUBLE_EQ(score.coverage, 1.0);
  EXPECT_DOUBLE_EQ(score.coverage_from_6_px, 1.0);
  EXPECT_DOUBLE_EQ(score.coverage_from_10_px, 0.0);  // there is no such vessel
  EXPECT_DOUBLE_EQ(score.false_positive, 0.0);
  EXPECT_EQ(score.cells, 200);
}

TEST(MapScore, CoversWhatItReachesByHalf)
{
  MapScorer scorer(straightVessel());
  const MapScore score = scorer.score(11, mapOf({0, 50, 100, 1}));
  // The view without its margin is 8..191; cells reach x = 99, and 4 px further: 96 of 184 px, the ends a px or two.
  EXPECT_NEAR(score.coverage, 96.0 / 184.0, 3.0 / 184.0);
}

TEST(MapScore, CallsFalseWhatLiesTooFarFromAnyVessel)
{
  MapScorer scorer(straightVessel());
  // The vessel's lowest row is 53: rows up to 57 are within the tolerance, 58 is not. Cells reach a px up and down.
  EXPECT_DOUBLE_EQ(scorer.score(11, mapOf({0, 56, 200, 1})).false_positive, 0.0);
  EXPECT_DOUBLE_EQ(scorer.score(11, mapOf({0, 62, 200, 1})).false_positive, 1.0);
  EXPECT_DOUBLE_EQ(scorer.score(11, mapOf({0, 62, 200, 1})).coverage, 0.0);
}

TEST(MapScore, AsksNothingBeforeAPlaceWasSeenOftenEnough)
{
  MapScorer scorer(straightVessel());
  EXPECT_DOUBLE_EQ(scorer.score(5, mapOf({})).coverage, 0.0);
  EXPECT_EQ(cv::countNonZero(scorer.verdicts()), 0);  // two looks stand for six frames
  scorer.score(6, mapOf({}));
  EXPECT_GT(cv::countNonZero(scorer.verdicts() == static_cast<int>(MapVerdict::missed)), 0);
}

TEST(MapScore, LeavesHiddenFramesOut)
{
  Truth truth = straightVessel();
  truth.poses[3].visible = false;
  MapScorer scorer(truth);
  scorer.score(8, mapOf({}));
  EXPECT_EQ(cv::countNonZero(scorer.verdicts()), 0);
  scorer.score(9, mapOf({}));
  EXPECT_GT(cv::countNonZero(scorer.verdicts()), 0);
}

TEST(MapScore, TellsFoundFromWrongFromMissed)
{
  MapScorer scorer(straightVessel());
  VesselMap map = mapOf({0, 50, 100, 1});
  const VesselMap stray = mapOf({0, 80, 60, 4});
  for (std::size_t i = 0; i < map.probability.size(); ++i) {
    map.probability[i] = std::max(map.probability[i], stray.probability[i]);
  }
  scorer.score(11, map);
  const auto at = [&](int x, int y) { return static_cast<MapVerdict>(scorer.verdicts()(y + 20, x + 10)); };
  EXPECT_EQ(at(40, 50), MapVerdict::found);
  EXPECT_EQ(at(40, 81), MapVerdict::wrong);
  EXPECT_EQ(at(150, 50), MapVerdict::missed);
  EXPECT_EQ(at(150, 30), MapVerdict::seen);
  EXPECT_EQ(at(2, 50), MapVerdict::unseen);
}

TEST(MapScore, RefusesFramesThatDoNotExistOrGoBack)
{
  MapScorer scorer(straightVessel());
  EXPECT_THROW(scorer.score(12, mapOf({})), std::invalid_argument);
  scorer.score(11, mapOf({}));
  EXPECT_THROW(scorer.score(2, mapOf({})), std::invalid_argument);
  EXPECT_THROW(MapScorer(Truth{}), std::invalid_argument);
}

TEST(Thinning, LeavesTheMiddleLineOfABar)
{
  cv::Mat_<std::uint8_t> bar(30, 60, std::uint8_t{0});
  cv::rectangle(bar, {5, 10}, {54, 18}, 1, -1);
  const cv::Mat_<std::uint8_t> line = eyeslam::files::thinned(bar);
  for (int column = 12; column < 48; ++column) {
    EXPECT_EQ(cv::countNonZero(line.col(column)), 1);
    EXPECT_NE(line(14, column), 0);
  }
}

}  // namespace
