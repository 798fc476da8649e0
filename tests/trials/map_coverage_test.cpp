// SPDX-License-Identifier: GPL-3.0-or-later
// How a map compares with the truth, on maps that are drawn.
#include "eyeslam/trials/map_coverage.h"

#include <gtest/gtest.h>

#include "support/drawn_vessels.h"

namespace {

using namespace eyeslam;
using Eigen::Vector2d;
using support::DrawnVessels;

constexpr double kUmPerPx = 5.0;

// Their calibre is that of the tube, as a truth has it.
retina::VesselMap truth(double thin_px, double thick_px)
{
  DrawnVessels drawn(200, 200);
  drawn.tube({{20, 50}, {180, 50}}, 0.5 * thin_px).tube({{20, 120}, {180, 120}}, 0.5 * thick_px);
  retina::VesselMap map = drawn.map();
  map.um_per_px = kUmPerPx;
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column)
      map.calibre_px[map.index(column, row)] = static_cast<std::uint8_t>(row < 85 ? thin_px : thick_px);
  return map;
}

Vector2d same(const Vector2d& px) { return px; }

TEST(MapCoverage, IsWholeForTheTruthItself)
{
  const retina::VesselMap map = truth(6.0, 20.0);
  const trials::MapCoverage score = trials::compareMap(map, map, same);
  EXPECT_FALSE(score.coverage[0]) << "no vessel is below 20 um";
  EXPECT_DOUBLE_EQ(score.coverage[1].value(), 1.0);
  EXPECT_DOUBLE_EQ(score.coverage[2].value(), 1.0);
  EXPECT_DOUBLE_EQ(score.precision.value(), 1.0);
}

TEST(MapCoverage, TellsWhatIsMissingByItsCalibre)
{
  DrawnVessels found(200, 200);
  found.tube({{20, 50}, {100, 50}}, 3.0).tube({{20, 120}, {180, 120}}, 10.0);
  const trials::MapCoverage score = trials::compareMap(found.map(), truth(6.0, 20.0), same);
  EXPECT_NEAR(score.coverage[1].value(), 0.5, 0.03);
  EXPECT_DOUBLE_EQ(score.coverage[2].value(), 1.0);
  EXPECT_DOUBLE_EQ(score.precision.value(), 1.0);
}

TEST(MapCoverage, CountsWhatIsNoVesselAgainstThePrecisionAlone)
{
  DrawnVessels found(200, 200);
  found.tube({{20, 50}, {180, 50}}, 3.0).tube({{20, 120}, {180, 120}}, 10.0).tube({{20, 170}, {180, 170}}, 10.0);
  const trials::MapCoverage score = trials::compareMap(found.map(), truth(6.0, 20.0), same);
  EXPECT_DOUBLE_EQ(score.coverage[2].value(), 1.0);
  EXPECT_NEAR(score.precision.value(), 26.0 / 46.0, 0.03);
}

TEST(MapCoverage, PassesOverWhatTheMapHasNotSeen)
{
  DrawnVessels found(200, 200);
  found.tube({{20, 50}, {100, 50}}, 3.0);
  for (int row = 0; row < 200; ++row)
    for (int column = 0; column < 200; ++column)
      if (column > 95 || row > 85) found.map().seen[found.map().index(column, row)] = 0;
  const trials::MapCoverage score = trials::compareMap(found.map(), truth(6.0, 20.0), same);
  EXPECT_DOUBLE_EQ(score.coverage[1].value(), 1.0);
  EXPECT_FALSE(score.coverage[2]);
}

TEST(MapCoverage, IsAskedThroughTheFramesOfBoth)
{
  DrawnVessels found(100, 100, 7.0, 5.0, 2.0);  // cells of 2 px
  found.tube({{20, 50}, {180, 50}}, 3.0).tube({{20, 120}, {180, 120}}, 10.0);
  const Vector2d shift(11.0, -4.0);
  retina::VesselMap moved = truth(6.0, 20.0);
  moved.origin_x = shift.x();
  moved.origin_y = shift.y();
  const trials::MapCoverage right =
      trials::compareMap(found.map(), moved, [&](const Vector2d& px) { return Vector2d(px - shift); });
  EXPECT_GT(right.coverage[2].value(), 0.93);
  EXPECT_DOUBLE_EQ(right.precision.value(), 1.0);
  EXPECT_LT(trials::compareMap(found.map(), moved, same).coverage[2].value(), 0.9);
}

TEST(CalibreClass, BeginsAtItsEdges)
{
  EXPECT_EQ(trials::calibreClass(19.9e-6), 0U);
  EXPECT_EQ(trials::calibreClass(20e-6), 1U);
  EXPECT_EQ(trials::calibreClass(49.9e-6), 1U);
  EXPECT_EQ(trials::calibreClass(50e-6), 2U);
}

}  // namespace
