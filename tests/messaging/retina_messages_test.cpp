// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/retina_messages.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

namespace eyeslam::messaging {
namespace {

/// A map whose cells all differ from their neighbours.
retina::VesselMap mapOf(int width, int height)
{
  retina::VesselMap map;
  map.width = width;
  map.height = height;
  map.origin_x = -12.5;
  map.origin_y = 7.0;
  map.px_per_cell = 2.0;
  map.version = 5;
  const std::size_t cells = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (std::size_t i = 0; i < cells; ++i) {
    map.probability.push_back(static_cast<std::uint8_t>(i % 251));
    map.calibre_px.push_back(static_cast<std::uint8_t>(i % 241));
    map.seen.push_back(static_cast<std::uint8_t>(i % 239));
  }
  return map;
}

void paste(const vessel_map_t& tile, retina::VesselMap& map)
{
  for (int row = 0; row < tile.height; ++row) {
    for (int column = 0; column < tile.width; ++column) {
      const auto from = static_cast<std::size_t>(row * tile.width + column);
      const std::size_t to = map.index(tile.column + column, tile.row + row);
      map.probability[to] = tile.probability[from];
      map.calibre_px[to] = tile.calibre_px[from];
      map.seen[to] = tile.seen[from];
    }
  }
}

RC_GTEST_PROP(MapTileCycle, CarriesTheWholeMapInOneCycleWhereverItStarts, ())
{
  const retina::VesselMap map = mapOf(*rc::gen::inRange(1, 95), *rc::gen::inRange(1, 95));
  MapTileCycle cycle;
  vessel_map_t tile{};
  for (int skipped = *rc::gen::inRange(0, 30); skipped > 0; --skipped) cycle.next(map, 1, 0, tile);

  retina::VesselMap copy = mapOf(map.width, map.height);
  copy.probability.assign(copy.probability.size(), 0);
  copy.calibre_px = copy.seen = copy.probability;
  for (int i = 0; i < MapTileCycle::tiles(map); ++i) {
    RC_ASSERT(cycle.next(map, 1, 0, tile));
    paste(tile, copy);
  }
  RC_ASSERT(copy.probability == map.probability);
  RC_ASSERT(copy.calibre_px == map.calibre_px);
  RC_ASSERT(copy.seen == map.seen);
}

TEST(MapTileCycle, StaysInsideAMapThatShrinksOrGrows)
{
  MapTileCycle cycle;
  vessel_map_t tile{};
  for (const int size : {100, 1, 21, 300, 20}) {
    const retina::VesselMap map = mapOf(size, size);
    for (int i = 0; i < 7; ++i) {
      ASSERT_TRUE(cycle.next(map, 1, 0, tile));
      EXPECT_LE(tile.column + tile.width, size);
      EXPECT_LE(tile.row + tile.height, size);
      EXPECT_EQ(tile.cells, tile.width * tile.height);
      EXPECT_EQ(tile.seen.size(), static_cast<std::size_t>(tile.cells));
    }
  }
}

TEST(MapTileCycle, HasNothingToSayOfAnEmptyMap)
{
  vessel_map_t tile{};
  EXPECT_FALSE(MapTileCycle().next(retina::VesselMap(), 1, 0, tile));
}

TEST(MapTileCycle, TellsWhereTheMapLies)
{
  vessel_map_t tile{};
  ASSERT_TRUE(MapTileCycle().next(mapOf(30, 40), 9, 77, tile));
  EXPECT_EQ(tile.map_id, 9);
  EXPECT_EQ(tile.utime, 77);
  EXPECT_EQ(tile.map_version, 5);
  EXPECT_EQ(tile.map_width, 30);
  EXPECT_EQ(tile.map_height, 40);
  EXPECT_EQ(tile.origin_x_px, -12.5);
  EXPECT_EQ(tile.px_per_cell, 2.0);
}

// What a controller needs must pass as one UDP fragment.
TEST(RetinaMessages, AreBelow1400Bytes)
{
  vessel_map_t tile{};
  ASSERT_TRUE(MapTileCycle().next(mapOf(100, 100), 1, 0, tile));
  EXPECT_EQ(tile.cells, MapTileCycle::kTile * MapTileCycle::kTile);
  EXPECT_LT(tile.getEncodedSize(), 1400);
  EXPECT_LT(retina_pose_t{}.getEncodedSize(), 1400);
  EXPECT_LT(tool_tip_t{}.getEncodedSize(), 1400);
}

TEST(RetinaPoseMessage, CarriesPoseCovarianceAndReason)
{
  RetinaMotion motion;
  motion.reason = retina::Reason::ambiguous;
  motion.map_T_frame = {1.0, 2.0, 0.3, 1.1};
  motion.velocity = {4.0, 5.0, 0.6};
  motion.covariance << 1, 2, 3, 2, 5, 6, 3, 6, 9;
  const retina_pose_t message = retinaPoseMessage({100, 7, 0.01}, {8, 9, 5.5}, motion);

  EXPECT_EQ(message.utime, 100);
  EXPECT_EQ(message.frame, 7);
  EXPECT_EQ(message.exposure, 0.01);
  EXPECT_FALSE(message.tracked);
  EXPECT_EQ(message.reason, 4);
  EXPECT_EQ(message.x_px, 1.0);
  EXPECT_EQ(message.y_px, 2.0);
  EXPECT_EQ(message.theta, 0.3);
  EXPECT_EQ(message.scale, 1.1);
  EXPECT_EQ(message.velocity_y_px, 5.0);
  EXPECT_EQ(message.covariance[1], 2.0);
  EXPECT_EQ(message.covariance[5], 6.0);
  EXPECT_EQ(message.covariance[8], 9.0);
  EXPECT_EQ(message.map_id, 8);
  EXPECT_EQ(message.map_version, 9);
  EXPECT_EQ(message.um_per_px, 5.5);
}

TEST(ToolTipMessage, IsZeroWhereNothingIsSeen)
{
  InstrumentSight sight;
  sight.tip.position_px = {5.0, 6.0};
  sight.spot = {true, {10.0, 20.0}, Eigen::Matrix2d::Identity()};
  const tool_tip_t message = toolTipMessage({100, 7, 0.0}, sight);
  EXPECT_FALSE(message.tip_present);
  EXPECT_EQ(message.tip_x_px, 0.0);
  EXPECT_TRUE(message.spot_present);
  EXPECT_EQ(message.spot_y_px, 20.0);
  EXPECT_EQ(message.spot_covariance[3], 1.0);
}

}  // namespace
}  // namespace eyeslam::messaging
