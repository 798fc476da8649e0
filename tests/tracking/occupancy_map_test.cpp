// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/occupancy_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "support/allocation_counter.h"
#include "support/vessel_scenes.h"

using namespace eyeslam;
using namespace eyeslam::tracking;
using eyeslam::retina::Pose2;

namespace {

const cv::Size kView(200, 152);  // frame px

/// The mask of a retina with a white instrument in its right half and a dark rim at its left.
struct SeenRetina {
  Frame frame;
  OcclusionMask mask;

  explicit SeenRetina(bool covered)
  {
    cv::Mat image(2 * kView.height, 2 * kView.width, CV_8UC3, cv::Scalar(30, 90, 180));
    if (covered) {
      cv::rectangle(image, {240, 100, 120, 80}, cv::Scalar(250, 250, 250), cv::FILLED);
      cv::rectangle(image, {0, 0, 60, image.rows}, cv::Scalar(5, 5, 10), cv::FILLED);
    }
    EXPECT_EQ(frame.assign(image), retina::Reason::none);
    mask.update(frame);
  }
};

cv::Mat_<std::uint8_t> copyOf(const OccupancyMap& map, const cv::Rect& cells)
{
  cv::Mat_<std::uint8_t> window;
  map.copyWindow(cells, window);
  return window.clone();
}

TEST(OccupancyMap, AddsMostToThePointsOwnCellLessBesideIt)
{
  OccupancyMap map;
  EXPECT_TRUE(map.empty());
  map.add({{-0.1F, 5.0F}}, {});  // cell (-1, 2)
  EXPECT_EQ(map.cell(-1, 2), 60);
  for (const auto& [i, j] : {std::pair(-2, 2), {0, 2}, {-1, 1}, {-1, 3}}) EXPECT_EQ(map.cell(i, j), 40);
  for (const auto& [i, j] : {std::pair(-2, 1), {0, 1}, {-2, 3}, {0, 3}}) EXPECT_EQ(map.cell(i, j), 30);
  EXPECT_EQ(cv::sum(copyOf(map, {-50, -50, 100, 100}))[0], 60 + 4 * 40 + 4 * 30);
  EXPECT_EQ(map.knownCells(), cv::Rect(-2, 1, 3, 3));
}

TEST(OccupancyMap, SaturatesAndNeverLowersWhatANeighbourRaised)
{
  OccupancyMap map;
  for (int n = 0; n < 50; ++n) map.add({{1.0F, 1.0F}}, {});
  EXPECT_EQ(map.cell(0, 0), 255);
  EXPECT_EQ(map.cell(1, 0), 190);
  EXPECT_EQ(map.cell(1, 1), 140);
  for (int n = 0; n < 50; ++n) map.add({{3.0F, 1.0F}}, {});
  EXPECT_EQ(map.cell(0, 0), 255);
  EXPECT_EQ(map.cell(1, 0), 255);
}

TEST(OccupancyMap, PlacesPointsByThePose)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-500.0, 500.0), angle(-3.0, 3.0), scale(0.8, 1.2);
  for (int n = 0; n < 500; ++n) {
    const Pose2 map_T_frame{shift(random), shift(random), angle(random), scale(random)};
    const Eigen::Vector2f point(static_cast<float>(shift(random)), static_cast<float>(shift(random)));
    OccupancyMap map;
    map.add({point}, map_T_frame);
    const Eigen::Vector2d in_map = map_T_frame * point.cast<double>();
    EXPECT_EQ(map.cell(static_cast<int>(std::floor(in_map.x() / 2)), static_cast<int>(std::floor(in_map.y() / 2))), 60);
  }
}

TEST(OccupancyMap, GrowsInAllDirectionsAndKeepsEveryProbability)
{
  std::mt19937 random(2);
  OccupancyMap map;
  map.add(support::randomVessels(random, 30, 400.0), {});
  const cv::Rect first = map.knownCells();
  const cv::Mat_<std::uint8_t> before = copyOf(map, first);
  for (const auto& [x, y] : {std::pair(3000.0F, 10.0F), {-3000.0F, 10.0F}, {10.0F, 3000.0F}, {10.0F, -3000.0F}}) {
    map.add({{x, y}}, {});
    EXPECT_EQ(cv::norm(copyOf(map, first), before, cv::NORM_INF), 0.0);
    EXPECT_EQ(map.cell(static_cast<int>(x) / 2, static_cast<int>(y) / 2), 60);
  }
  EXPECT_EQ(map.knownCells(), cv::Rect(-1501, -1501, 3003, 3003));
}

TEST(OccupancyMap, CopiesAnyWindowCellByCell)
{
  std::mt19937 random(3);
  OccupancyMap map;
  map.add(support::randomVessels(random, 30, 500.0), {});
  std::uniform_int_distribution<int> corner(-250, 200), side(1, 150);
  for (int n = 0; n < 50; ++n) {
    const cv::Rect cells(corner(random), corner(random), side(random), side(random));
    const cv::Mat_<std::uint8_t> window = copyOf(map, cells);
    ASSERT_EQ(window.size(), cells.size());
    for (int y = 0; y < cells.height; ++y) {
      for (int x = 0; x < cells.width; ++x) ASSERT_EQ(window(y, x), map.cell(cells.x + x, cells.y + y));
    }
  }
}

TEST(OccupancyMap, IgnoresPointsThatAreNotFiniteOrOutOfReach)
{
  OccupancyMap map;
  map.add({{NAN, 0.0F}, {0.0F, HUGE_VALF}, {1e9F, 0.0F}, {0.0F, -1e9F}}, {});
  map.add({{1.0F, 1.0F}}, {NAN, 0.0, 0.0, 1.0});
  map.add({{1.0F, 1.0F}}, {1e300, 0.0, 0.0, 1.0});
  EXPECT_TRUE(map.empty());
}

// Each cell by hand: its centre is taken into the frame, and it decays when the mask shows retina there, else not.
TEST(OccupancyMap, DecaysOnlyInTheVisibleViewAndOnlyTheRowsWhoseTurnItIs)
{
  std::mt19937 random(4);
  const SeenRetina seen(true);
  ASSERT_GT(seen.mask.visibleFraction(), 0.5);
  ASSERT_LT(seen.mask.visibleFraction(), 0.95);
  const cv::Rect area(-200, -200, 400, 400);
  for (std::int64_t number = 0; number < 8; ++number) {
    SCOPED_TRACE(number);
    OccupancyMap map;
    map.add(support::randomVessels(random, 80, 600.0), {});
    const cv::Mat_<std::uint8_t> before = copyOf(map, area);
    const Pose2 map_T_frame{-20.0 + 7.0 * static_cast<double>(number), 15.0, 0.1 * static_cast<double>(number), 1.05};
    map.decay(seen.mask, kView, map_T_frame, number);
    const cv::Mat_<std::uint8_t> after = copyOf(map, area);
    int lowered = 0, kept = 0;
    for (int y = 0; y < area.height; ++y) {
      for (int x = 0; x < area.width; ++x) {
        const int i = area.x + x, j = area.y + y;
        const Eigen::Vector2d pixel = map_T_frame.inverse() * Eigen::Vector2d(2.0 * i + 1.0, 2.0 * j + 1.0) +
                                      Eigen::Vector2d(kView.width - 1, kView.height - 1) / 2.0;
        const Eigen::Vector2d nearest = pixel.array().round();
        // Within rounding of a pixel's edge either is right.
        if ((pixel - nearest).cwiseAbs().maxCoeff() > 0.5 - 1e-6) continue;
        const bool turn = ((j % 4) + 4) % 4 == number % 4;
        const bool visible = seen.mask.isVisible(static_cast<int>(nearest.x()), static_cast<int>(nearest.y()));
        ASSERT_EQ(after(y, x), turn && visible ? std::max(0, before(y, x) - 12) : before(y, x)) << i << ", " << j;
        (after(y, x) < before(y, x) ? lowered : kept) += before(y, x) > 0 ? 1 : 0;
      }
    }
    EXPECT_GT(lowered, 100);
    EXPECT_GT(kept, 100);
  }
}

TEST(OccupancyMap, ForgetsInPlainViewWhatIsNotSeenAgain)
{
  const SeenRetina seen(false);
  OccupancyMap map;
  support::saturate(map, {{10.0F, 10.0F}});
  for (std::int64_t frame = 0; frame < 22 * 4; ++frame) map.decay(seen.mask, kView, {}, frame);  // 255 / 12 turns
  EXPECT_EQ(map.cell(5, 5), 0);
}

TEST(OccupancyMap, IgnoresAPoseThatIsNone)
{
  const SeenRetina seen(false);
  OccupancyMap map;
  map.add({{1.0F, 1.0F}}, {});
  for (const Pose2& pose : {Pose2{NAN, 0, 0, 1}, Pose2{0, 0, NAN, 1}, Pose2{0, 0, 0, 0}, Pose2{1e300, 0, 0, 1}}) {
    for (std::int64_t frame = 0; frame < 4; ++frame) map.decay(seen.mask, kView, pose, frame);
  }
  EXPECT_EQ(map.cell(0, 0), 60);
}

TEST(OccupancyMap, IsEmptyAgainWhenCleared)
{
  OccupancyMap map;
  map.add({{1.0F, 1.0F}}, {});
  const std::uint32_t changes = map.changes();
  map.clear();
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.cell(0, 0), 0);
  EXPECT_NE(map.changes(), changes);
}

TEST(OccupancyMap, AllocatesOnlyForNewTiles)
{
  std::mt19937 random(5);
  const SeenRetina seen(true);
  const ScanPoints vessels = support::randomVessels(random, 60, 500.0);
  OccupancyMap map;
  map.add(vessels, {});
  cv::Mat_<std::uint8_t> window(152, 200);
  const std::int64_t before = support::allocations();
  for (std::int64_t frame = 0; frame < 20; ++frame) {
    map.add(vessels, {});
    map.decay(seen.mask, kView, {static_cast<double>(frame), 0.0, 0.02, 1.0}, frame);
    map.copyWindow({-100, -76, 200, 152}, window);
  }
  EXPECT_EQ(support::allocations(), before);
}

TEST(OccupancyMap, IsTheSameForTheSameFrames)
{
  const SeenRetina seen(true);
  cv::Mat_<std::uint8_t> maps[2];
  for (cv::Mat_<std::uint8_t>& copy : maps) {
    std::mt19937 random(6);
    OccupancyMap map;
    for (std::int64_t frame = 0; frame < 10; ++frame) {
      map.add(support::randomVessels(random, 20, 300.0), {});
      map.decay(seen.mask, kView, {}, frame);
    }
    copy = copyOf(map, {-200, -200, 400, 400});
  }
  EXPECT_EQ(cv::norm(maps[0], maps[1], cv::NORM_INF), 0.0);
}

}  // namespace
