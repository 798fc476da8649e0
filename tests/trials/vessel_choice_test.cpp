// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/vessel_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/random_vessels.h"

namespace eyeslam::trials {
namespace {

using Eigen::Vector2d;
using fixtures::Vessel;

/// A vessel that is as wide as it is wished for.
Vessel wide(int id, const std::vector<Vector2d>& corners, std::array<int, 2> ends = {-1, -1}, double radius_px = 6.0)
{
  return support::vesselThrough(id, corners, ends, radius_px);
}

fixtures::VesselNetwork networkOf(std::vector<Vessel> vessels)
{
  fixtures::VesselNetwork network;
  network.vessels = std::move(vessels);
  return network;
}

constexpr double kBeyond = 60.0;

VesselWish wish()
{
  VesselWish wish;
  wish.area_px = Eigen::AlignedBox2d(Vector2d(0.0, 0.0), Vector2d(2000.0, 2000.0));
  wish.longest_px = 1e4;
  wish.radius_px = 5.0;
  wish.apart_px = 40.0;
  wish.beyond_px = kBeyond;
  return wish;
}

double lengthOf(const std::vector<Vector2d>& way)
{
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
  return length;
}

TEST(VesselChoice, TakesTheLongestOfVesselsThatAreAlone)
{
  const ChosenVessel chosen =
      vesselToTrace(networkOf({wide(1, {{100, 200}, {600, 200}}), wide(2, {{100, 500}, {900, 500}}),
                               wide(3, {{100, 800}, {700, 800}})}),
                    wish());
  ASSERT_FALSE(chosen.centreline.empty());
  for (const Vector2d& place : chosen.centreline) EXPECT_NEAR(place.y(), 500.0, 1e-9);
}

TEST(VesselChoice, TakesAShorterVesselRatherThanOneThatRunsBesideAnother)
{
  // 800 px with a neighbour 30 px beside it all the way, against 500 px alone.
  const std::vector<Vessel> vessels{wide(1, {{100, 200}, {900, 200}}), wide(2, {{100, 230}, {900, 230}}),
                                    wide(3, {{100, 800}, {600, 800}})};
  const ChosenVessel chosen = vesselToTrace(networkOf(vessels), wish());
  ASSERT_FALSE(chosen.centreline.empty());
  EXPECT_NEAR(chosen.centreline.front().y(), 800.0, 1e-9);
  VesselWish careless = wish();
  careless.apart_px = 20.0;
  EXPECT_NEAR(vesselToTrace(networkOf(vessels), careless).centreline.front().y(), 200.0, 20.0 + kBeyond);
}

// A capillary that nobody would trace is a neighbour all the same.
TEST(VesselChoice, CountsNeighboursThatAreTooThinToTrace)
{
  const ChosenVessel chosen =
      vesselToTrace(networkOf({wide(1, {{100, 200}, {900, 200}}), wide(2, {{100, 230}, {900, 230}}, {-1, -1}, 2.0),
                               wide(3, {{100, 800}, {600, 800}})}),
                    wish());
  ASSERT_FALSE(chosen.centreline.empty());
  EXPECT_NEAR(chosen.centreline.front().y(), 800.0, 1e-9);
}

TEST(VesselChoice, CutsTheWayWhereItTurnsSharply)
{
  const ChosenVessel chosen = vesselToTrace(networkOf({wide(1, {{100, 200}, {500, 200}, {500, 1100}})}), wish());
  const std::vector<Vector2d> way = chosen.centreline;
  ASSERT_GT(way.size(), 700U) << "the longer limb";
  for (const Vector2d& place : way) EXPECT_NEAR(place.x(), 500.0, 1e-9) << place.transpose();
  // A bend of 20 degrees is none.
  const Vector2d corner(500, 200), end = corner + 900.0 * Vector2d(std::cos(0.35), std::sin(0.35));
  EXPECT_GT(lengthOf(vesselToTrace(networkOf({wide(1, {{100, 200}, corner, end})}), wish()).centreline), 1100.0);
}

TEST(VesselChoice, KeepsWhatIsWishedOfTheVesselBeyondBothEnds)
{
  for (const double longest : {1e4, 300.0}) {
    VesselWish limited = wish();
    limited.longest_px = longest;
    const ChosenVessel chosen = vesselToTrace(networkOf({wide(1, {{100, 200}, {900, 200}})}), limited);
    EXPECT_NEAR(lengthOf(chosen.centreline), std::min(longest, 800.0 - 2 * kBeyond), 2.0);
    ASSERT_GT(chosen.centreline.size(), 1U);
    for (const bool front : {true, false}) {
      const Vector2d end = front ? chosen.centreline.front() : chosen.centreline.back();
      const Vector2d beyond = front ? chosen.leaned_on.front() : chosen.leaned_on.back();
      EXPECT_NEAR((beyond - end).norm(), kBeyond, 2.0);
    }
    EXPECT_LT((chosen.middle - Vector2d(500, 200)).norm(), longest > 1000 ? 2.0 : 400.0);
  }
  EXPECT_EQ(vesselToTrace(networkOf({wide(1, {{100, 200}, {100 + 2 * kBeyond, 200}})}), wish()).centreline.size(), 0U)
      << "too short to go on beyond both ends";
}

TEST(VesselChoice, GoesStraightOnThroughAJunction)
{
  const Vector2d junction(500, 500);
  const ChosenVessel chosen =
      vesselToTrace(networkOf({wide(1, {{100, 500}, junction}, {-1, 7}), wide(2, {junction, {900, 500}}, {7, -1}),
                               wide(3, {junction, {650, 950}}, {7, -1})}),
                    wish());
  EXPECT_NEAR(lengthOf(chosen.centreline), 800.0 - 2 * kBeyond, 2.0);
  for (const Vector2d& place : chosen.centreline) EXPECT_NEAR(place.y(), 500.0, 1e-9);
}

// At a fork a map may have either branch nearest.
TEST(VesselChoice, TellsWhereOnItOneIsFarFromOthers)
{
  const Vector2d fork(500, 500);
  const ChosenVessel chosen =
      vesselToTrace(networkOf({wide(1, {{100, 500}, fork}, {-1, 7}), wide(2, {fork, {900, 500}}, {7, -1}),
                               wide(3, {fork, {850, 950}}, {7, -1})}),
                    wish());
  ASSERT_FALSE(chosen.centreline.empty());
  EXPECT_NEAR(chosen.centreline[chosen.clear_at].x(), 100.0 + kBeyond, 1.0);
  // Also where what is traced is a small part of its vessel, whose middle is elsewhere.
  VesselWish at_the_end = wish();
  at_the_end.area_px = Eigen::AlignedBox2d(Vector2d(600.0, 400.0), Vector2d(800.0, 600.0));
  at_the_end.apart_px = 0.0;
  const ChosenVessel part =
      vesselToTrace(networkOf({wide(1, {{100, 500}, {900, 500}}),
                               support::vesselThrough(2, {{600, 450}, {640, 450}}, {-1, -1}, 2.0)}),
                    at_the_end);
  ASSERT_FALSE(part.centreline.empty());
  EXPECT_NEAR(part.centreline[part.clear_at].x(), 800.0, 2.0);
}

// At its end it divides: one of the two is as wide as it is, the other one straighter.
TEST(VesselChoice, GoesOnAsAFixtureThatKeepsToItWould)
{
  const Vector2d fork(700, 500);
  const ChosenVessel chosen =
      vesselToTrace(networkOf({wide(1, {{100, 500}, fork}, {-1, 7}), wide(2, {fork, {850, 560}}, {7, -1}),
                               support::vesselThrough(3, {fork, {850, 450}}, {7, -1}, 2.0)}),
                    wish());
  ASSERT_FALSE(chosen.centreline.empty());
  const bool backwards = chosen.leaned_on.front().x() > chosen.leaned_on.back().x();
  const Vector2d end = backwards ? chosen.leaned_on.front() : chosen.leaned_on.back();
  EXPECT_LT((end - Vector2d(850, 560)).norm(), 1e-6) << end.transpose();
}

TEST(VesselChoice, EndsFarFromAWiderVesselAcrossItsWay)
{
  for (const double crossing : {700.0, 1900.0}) {  // the second is elsewhere
    const std::vector<Vessel> vessels{wide(1, {{100, 400}, {1100, 400}}),
                                      wide(2, {{crossing, 0}, {crossing, 800}}, {-1, -1}, 13.0)};
    const std::vector<Vector2d> way = vesselToTrace(networkOf(vessels), wish()).centreline;
    ASSERT_GT(way.size(), 100U);
    const double end = std::max(way.front().x(), way.back().x());
    EXPECT_NEAR(end, crossing < 1100.0 ? 700.0 - 13.0 - 3.0 * 6.0 - kBeyond : 1100.0 - kBeyond, 8.0);
  }
}

TEST(VesselChoice, EndsFarFromABend)
{
  const std::vector<Vector2d> way =
      vesselToTrace(networkOf({wide(1, {{100, 200}, {900, 200}, {900, 300}})}), wish()).centreline;
  ASSERT_GT(way.size(), 100U);
  for (const Vector2d& place : way) EXPECT_LT(place.x(), 900.0 - kBeyond + 1.0) << place.transpose();
}

TEST(VesselChoice, StaysWithinItsArea)
{
  VesselWish small = wish();
  small.area_px = Eigen::AlignedBox2d(Vector2d(300.0, 100.0), Vector2d(450.0, 300.0));
  const std::vector<Vector2d> way = vesselToTrace(networkOf({wide(1, {{100, 200}, {900, 200}})}), small).centreline;
  ASSERT_GT(way.size(), 100U);
  for (const Vector2d& place : way) EXPECT_TRUE(small.area_px.contains(place));
}

TEST(VesselChoice, FindsNothingWhereNothingIsWideEnough)
{
  EXPECT_EQ(vesselToTrace(networkOf({wide(1, {{100, 200}, {900, 200}}, {-1, -1}, 4.0)}), wish()).centreline.size(), 0U);
  EXPECT_EQ(vesselToTrace({}, wish()).centreline.size(), 0U);
}

}  // namespace
}  // namespace eyeslam::trials
