// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/relocalizer.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "eyeslam/tracking/whole_map_tables.h"
#include "support/allocation_counter.h"
#include "support/exhaustive_search.h"
#include "support/vessel_scenes.h"

using namespace eyeslam;
using namespace eyeslam::tracking;
using eyeslam::retina::Pose2;
using eyeslam::retina::Reason;

namespace {

constexpr double kCell_px = 2.0;
constexpr double kDegree = M_PI / 180.0;

double uniform(std::mt19937& random, double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Vessels over a square, and a relocalizer for views of 400 x 304 px.
struct Scene {
  std::mt19937 random;
  ScanPoints vessels;
  OccupancyMap map;
  Relocalizer relocalizer;

  Scene(unsigned seed, int count, double side_px, const RelocalizerOptions& options = {})
      : random(seed), vessels(support::randomVessels(random, count, side_px)), relocalizer(options)
  {
    support::saturate(map, vessels);
    relocalizer.reserve({400, 304});
  }
  ScanPoints viewFrom(const Pose2& pose) { return support::seenFrom(pose, vessels, 400, 304, 500, 0.7, 0.15, random); }
  Pose2 randomPose(double reach_px, double reach_deg)
  {
    return {uniform(random, -reach_px, reach_px), uniform(random, -reach_px, reach_px),
            uniform(random, -reach_deg, reach_deg) * kDegree, 1.0};
  }
};

void expectNear(const MatchResult& found, const Pose2& truth)
{
  EXPECT_EQ(found.reason, Reason::none) << found.score;
  // A vessel in the map is three cells wide.
  EXPECT_NEAR(found.map_T_frame.x, truth.x, 1.5 * kCell_px);
  EXPECT_NEAR(found.map_T_frame.y, truth.y, 1.5 * kCell_px);
  EXPECT_NEAR(retina::wrapAngle(found.map_T_frame.theta - truth.theta), 0.0, 2.0 * kCell_px / 100.0);
}

MatchResult searchUntilAnswered(Scene& scene, const Pose2& truth, int most_calls, int& calls)
{
  MatchResult found;
  calls = 0;
  do {
    found = scene.relocalizer.search(scene.viewFrom(truth), scene.map, {});
  } while (found.reason == Reason::searching && ++calls < most_calls);
  scene.relocalizer.restart();
  return found;
}

TEST(Relocalizer, FindsAViewAnywhereInTheMapInOneCall)
{
  Scene scene(1, 60, 1200.0);
  while (!scene.relocalizer.prepare(scene.map)) continue;
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const Pose2 truth = scene.randomPose(400.0, 14.0);
    expectNear(scene.relocalizer.search(scene.viewFrom(truth), scene.map, {}), truth);
  }
}

TEST(Relocalizer, FindsAViewTurnedFullCircleWhenAsked)
{
  RelocalizerOptions options;
  options.half_angle_deg = 180.0;
  Scene scene(2, 60, 1000.0, options);
  for (int i = 0; i < 10; ++i) {
    SCOPED_TRACE(i);
    const Pose2 truth = scene.randomPose(300.0, 180.0);
    int calls = 0;
    expectNear(searchUntilAnswered(scene, truth, 100, calls), truth);
  }
}

TEST(Relocalizer, AsksForMoreFramesOnALargeMapAndFindsTheViewThen)
{
  Scene scene(3, 1200, 5600.0);
  const Pose2 truth{-1900.0, 1700.0, 11.0 * kDegree, 1.0};
  int calls = 0;
  const MatchResult found = searchUntilAnswered(scene, truth, 60, calls);
  EXPECT_GT(calls, 1);
  expectNear(found, truth);
}

TEST(Relocalizer, FindsLargeViewsOnLargerCells)
{
  std::mt19937 random(4);
  const ScanPoints vessels = support::randomVessels(random, 80, 2400.0);
  OccupancyMap map;
  support::saturate(map, vessels);
  Relocalizer relocalizer;
  relocalizer.reserve({960, 540});
  for (int i = 0; i < 10; ++i) {
    SCOPED_TRACE(i);
    const Pose2 truth{uniform(random, -600, 600), uniform(random, -600, 600), uniform(random, -0.2, 0.2), 1.0};
    const ScanPoints points = support::seenFrom(truth, vessels, 960, 540, 500, 0.7, 0.15, random);
    MatchResult found;
    int calls = 0;
    do {
      found = relocalizer.search(points, map, {});
    } while (found.reason == Reason::searching && ++calls < 50);
    EXPECT_EQ(found.reason, Reason::none);
    EXPECT_NEAR(found.map_T_frame.x, truth.x, 1.5 * kCell_px);
    EXPECT_NEAR(found.map_T_frame.y, truth.y, 1.5 * kCell_px);
  }
}

// On a small map the answer scores what no pose of an exhaustive search beats by more than a cell's shift of the grid.
TEST(Relocalizer, ScoresWhatExhaustiveSearchScores)
{
  for (unsigned seed = 10; seed < 16; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const ScanPoints vessels = support::randomVessels(random, 15, 160.0);
    OccupancyMap map;
    support::saturate(map, vessels);
    const Pose2 truth{uniform(random, -30, 30), uniform(random, -30, 30), uniform(random, -0.1, 0.1), 1.0};
    const ScanPoints points = support::seenFrom(truth, vessels, 90, 70, 150, 0.5, 0.1, random);
    RelocalizerOptions options;
    options.ambiguous_ratio = 2.0;
    const MatchResult found = Relocalizer(options).search(points, map, {});
    const MatchResult best = support::searchExhaustively(points, map, {{}, 90.0, 90.0, 15.0 * kDegree});
    EXPECT_GE(found.score, 0.95 * best.score);
  }
}

TEST(Relocalizer, NoticesWhenTheMapHasGrown)
{
  Scene scene(5, 40, 700.0);
  EXPECT_EQ(scene.relocalizer.search(scene.viewFrom({}), scene.map, {}).reason, Reason::none);
  const ScanPoints further = support::randomVessels(scene.random, 40, 700.0);
  ScanPoints moved;
  for (const Eigen::Vector2f& point : further) moved.emplace_back(point.x() + 900.0F, point.y());
  support::saturate(scene.map, moved);
  const Pose2 truth{900.0, 0.0, 0.05, 1.0};
  const ScanPoints points = support::seenFrom(truth, moved, 400, 304, 500, 0.5, 0.1, scene.random);
  expectNear(scene.relocalizer.search(points, scene.map, {}), truth);
}

TEST(Relocalizer, ForgetsAMapThatWasClearedAndGrewToTheSameRectangleAgain)
{
  Scene scene(23, 40, 700.0);
  const ScanPoints view = scene.viewFrom({});
  ASSERT_EQ(scene.relocalizer.search(view, scene.map, {}).reason, Reason::none);
  const cv::Rect known = scene.map.knownCells();
  scene.map.clear();
  const ScanPoints corners{
      {kCell_px * static_cast<float>(known.x + 1.5), kCell_px * static_cast<float>(known.y + 1.5)},
      {kCell_px * static_cast<float>(known.br().x - 1.5), kCell_px * static_cast<float>(known.br().y - 1.5)}};
  support::saturate(scene.map, corners);
  ASSERT_EQ(scene.map.knownCells(), known);
  const MatchResult found = scene.relocalizer.search(view, scene.map, {});
  EXPECT_NE(found.reason, Reason::none);
  EXPECT_NE(found.reason, Reason::searching) << "it must not have looked at the old map's tables";
}

// 4 KB pages in memory now.
std::int64_t residentPages()
{
  std::int64_t size = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> size >> resident;
  return resident;
}

TEST(Relocalizer, NeedsNoGigabytesForPointsAtTheEndsOfTheMapsReach)
{
  Scene scene(24, 60, 900.0);
  const float far_px = 2.0F * (OccupancyMap::kReach_cells - 2);
  support::saturate(scene.map, {{far_px, far_px}, {-far_px, -far_px}});
  const cv::Rect finest = WholeMapTables::areaOf(scene.map.knownCells(), 1, 0);
  ASSERT_GT(std::int64_t{finest.width} * finest.height, 10 * WholeMapTables::kMostCells) << "it would take 3 GB";
  const std::int64_t before = residentPages();
  const Pose2 truth{150.0, -90.0, 0.05, 1.0};
  int calls = 0;
  const MatchResult found = searchUntilAnswered(scene, truth, 60, calls);
  if (found.reason == Reason::none) expectNear(found, truth);
  EXPECT_LT(residentPages() - before, 200 * 256) << "200 MB: four bytes for each of the most cells, and the points";
}

TEST(Relocalizer, FindsNothingThatIsNotThere)
{
  Scene scene(6, 25, 900.0);
  std::mt19937 random(7);
  const ScanPoints elsewhere = support::randomVessels(random, 25, 900.0);
  for (int i = 0; i < 10; ++i) {
    const ScanPoints points = support::seenFrom({}, elsewhere, 400, 304, 500, 0.5, 0.1, random);
    EXPECT_NE(scene.relocalizer.search(points, scene.map, {}).reason, Reason::none);
  }
}

TEST(Relocalizer, CallsRepeatedVesselsAmbiguous)
{
  std::mt19937 random(8);
  const ScanPoints vessels = support::randomVessels(random, 20, 400.0);
  ScanPoints twice = vessels;
  for (const Eigen::Vector2f& point : vessels) twice.emplace_back(point.x() + 600.0F, point.y() + 40.0F);
  OccupancyMap map;
  support::saturate(map, twice);
  const ScanPoints points = support::seenFrom({}, vessels, 300, 300, 500, 0.2, 0.0, random);
  EXPECT_EQ(Relocalizer().search(points, map, {}).reason, Reason::ambiguous);
}

TEST(Relocalizer, RefusesWhatItCannotSearch)
{
  Scene scene(9, 30, 500.0);
  EXPECT_EQ(scene.relocalizer.search({}, scene.map, {}).reason, Reason::too_few_points);
  EXPECT_EQ(scene.relocalizer.search(scene.viewFrom({}), OccupancyMap(), {}).reason, Reason::poor_match);
  EXPECT_EQ(scene.relocalizer.search(scene.viewFrom({}), scene.map, {NAN, 0, 0, 1}).reason, Reason::poor_match);
}

TEST(Relocalizer, AnswersTheSameTwice)
{
  for (int run = 0; run < 2; ++run) {
    static MatchResult first;
    Scene scene(20, 60, 1000.0);
    const MatchResult found = scene.relocalizer.search(scene.viewFrom({50.0, 60.0, 0.1, 1.0}), scene.map, {});
    if (run == 0) first = found;
    EXPECT_EQ(found.map_T_frame.x, first.map_T_frame.x);
    EXPECT_EQ(found.score, first.score);
    EXPECT_EQ(found.covariance, first.covariance);
  }
}

TEST(Relocalizer, AllocatesNothingWhileTheMapStays)
{
  Scene scene(21, 60, 1000.0);
  std::vector<ScanPoints> views;
  for (int i = 0; i < 6; ++i) views.push_back(scene.viewFrom(scene.randomPose(300.0, 14.0)));
  scene.relocalizer.search(views[0], scene.map, {});
  scene.relocalizer.search(views[0], scene.map, {});
  const std::int64_t before = support::allocations();
  for (const ScanPoints& points : views) scene.relocalizer.search(points, scene.map, {});
  EXPECT_EQ(support::allocations(), before);
}

}  // namespace
