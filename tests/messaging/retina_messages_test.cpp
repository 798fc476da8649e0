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

TEST(MapTileCycle, FillsATileBelow1400Bytes)
{
  vessel_map_t tile{};
  ASSERT_TRUE(MapTileCycle().next(mapOf(100, 100), 1, 0, tile));
  EXPECT_EQ(tile.cells, MapTileCycle::kTile * MapTileCycle::kTile);
  EXPECT_LT(tile.getEncodedSize(), 1400);
}

}  // namespace
}  // namespace eyeslam::messaging
