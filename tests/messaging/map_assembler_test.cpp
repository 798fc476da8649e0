// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/map_assembler.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "eyeslam/messaging/retina_messages.h"

namespace eyeslam::messaging {
namespace {

using retina::Reason;
using retina::VesselMap;

/// A map that covers columns [left, left + width) and rows [top, top + height) of one endless retina.
VesselMap mapOf(int left, int top, int width, int height, std::uint64_t version = 1)
{
  VesselMap map;
  map.width = width;
  map.height = height;
  map.px_per_cell = 2.0;
  map.origin_x = 2.0 * left + 0.5;
  map.origin_y = 2.0 * top - 0.25;
  map.um_per_px = 5.0;
  map.version = version;
  for (int row = top; row < top + height; ++row) {
    for (int column = left; column < left + width; ++column) {
      const int cell = 31 * row + 17 * column + 100'000;
      map.probability.push_back(static_cast<std::uint8_t>(cell % 251));
      map.calibre_px.push_back(static_cast<std::uint8_t>(cell % 241));
      map.seen.push_back(static_cast<std::uint8_t>(1 + cell % 239));
    }
  }
  return map;
}

std::vector<vessel_map_t> tilesOf(const VesselMap& map, std::int64_t map_id = 1)
{
  MapTileCycle cycle;
  std::vector<vessel_map_t> tiles(static_cast<std::size_t>(MapTileCycle::tiles(map)));
  for (vessel_map_t& tile : tiles) cycle.next(map, map_id, 1, tile);
  return tiles;
}

bool same(const VesselMap& a, const VesselMap& b)
{
  return a.width == b.width && a.height == b.height && a.origin_x == b.origin_x && a.origin_y == b.origin_y &&
         a.px_per_cell == b.px_per_cell && a.um_per_px == b.um_per_px && a.version == b.version &&
         a.probability == b.probability && a.calibre_px == b.calibre_px && a.seen == b.seen;
}

RC_GTEST_PROP(MapAssembler, HasTheMapAfterEachTileCameOnceInAnyOrderWithRepetitions, (std::uint32_t seed))
{
  std::mt19937 random(seed);
  const VesselMap map = mapOf(-7, 3, *rc::gen::inRange(1, 95), *rc::gen::inRange(1, 95));
  std::vector<vessel_map_t> tiles = tilesOf(map);
  std::shuffle(tiles.begin(), tiles.end(), random);
  MapAssembler assembler;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    RC_ASSERT(!assembler.isComplete());
    assembler.add(tiles[i]);
    assembler.add(tiles[random() % (i + 1)]);
  }
  RC_ASSERT(assembler.isComplete());
  RC_ASSERT(same(assembler.map(), map));
}

// Growth in all four directions, every step of it losing tiles: what was known stays, and a last cycle completes it.
RC_GTEST_PROP(MapAssembler, SurvivesGrowthAndLoss, (std::uint32_t seed))
{
  std::mt19937 random(seed);
  MapAssembler assembler;
  int left = 0, top = 0, right = 30, bottom = 25;
  std::uint64_t version = 1;
  for (int step = 0; step < 5; ++step) {
    const VesselMap map = mapOf(left, top, right - left, bottom - top, ++version);
    const std::size_t unknown = assembler.unknownCells();
    for (const vessel_map_t& tile : tilesOf(map)) {
      if (random() % 3 != 0) assembler.add(tile);
    }
    for (int i = 0; i < assembler.map().width * assembler.map().height; ++i) {
      const auto cell = static_cast<std::size_t>(i);
      RC_ASSERT(assembler.map().seen[cell] == 0 || assembler.map().seen[cell] == map.seen[cell]);
    }
    RC_ASSERT(step > 0 || assembler.unknownCells() >= unknown);
    left -= static_cast<int>(random() % 30);
    top -= static_cast<int>(random() % 30);
    right += static_cast<int>(random() % 30);
    bottom += static_cast<int>(random() % 30);
  }
  const VesselMap last = mapOf(left, top, right - left, bottom - top, ++version);
  for (const vessel_map_t& tile : tilesOf(last)) assembler.add(tile);
  RC_ASSERT(assembler.isComplete());
  RC_ASSERT(same(assembler.map(), last));
}

TEST(MapAssembler, KeepsWhatItKnowsWhenTheMapGrows)
{
  MapAssembler assembler;
  for (const vessel_map_t& tile : tilesOf(mapOf(0, 0, 40, 40))) assembler.add(tile);
  ASSERT_TRUE(assembler.isComplete());
  const std::vector<vessel_map_t> grown = tilesOf(mapOf(-20, -20, 80, 80, 2));
  assembler.add(grown.front());
  EXPECT_EQ(assembler.unknownCells(), 80U * 80U - 40U * 40U - 20U * 20U);
  EXPECT_EQ(assembler.map().seen[assembler.map().index(20, 20)], mapOf(0, 0, 40, 40).seen[0]);
}

VesselMap movedBy(VesselMap map, double x_px, double y_px, std::uint64_t version)
{
  map.origin_x += x_px;
  map.origin_y += y_px;
  map.version = version;
  return map;
}

// What the tracker's anchor learns moves the whole grid, a tile at another place than the one before.
TEST(MapAssembler, KeepsWhatItKnowsWhileTheGridMovesByHundredthsOfAPixelBetweenTiles)
{
  const VesselMap map = mapOf(-7, 3, 80, 70);
  const std::vector<vessel_map_t> tiles = tilesOf(map);
  ASSERT_GT(tiles.size(), 2U);
  MapAssembler assembler;
  VesselMap moved = map;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    moved = movedBy(moved, 0.03, -0.02, 1 + i);
    assembler.add(tilesOf(moved)[i]);
  }
  EXPECT_TRUE(assembler.isComplete());
  EXPECT_TRUE(same(assembler.map(), moved)) << "its place is the newest tile's";
}

TEST(MapAssembler, KeepsWhatItKnowsWhenTheMapGrowsAndItsGridMovesALittle)
{
  MapAssembler assembler;
  for (const vessel_map_t& tile : tilesOf(mapOf(0, 0, 40, 40))) assembler.add(tile);
  const VesselMap grown = movedBy(mapOf(-20, -20, 80, 80), 0.04, -0.04, 2);
  assembler.add(tilesOf(grown).front());
  EXPECT_EQ(assembler.unknownCells(), 80U * 80U - 40U * 40U - 20U * 20U);
  EXPECT_EQ(assembler.map().seen[assembler.map().index(20, 20)], mapOf(0, 0, 40, 40).seen[0]);
  EXPECT_EQ(assembler.map().origin_x, grown.origin_x);
}

TEST(MapAssembler, BeginsAnewWhenTheGridMovesByHalfACell)
{
  for (const auto& [x_px, y_px] : {std::pair{1.0, 0.0}, {0.0, -1.0}, {0.6, 0.0}}) {
    MapAssembler assembler;
    const VesselMap map = mapOf(0, 0, 40, 40);
    for (const vessel_map_t& tile : tilesOf(map)) assembler.add(tile);
    assembler.add(tilesOf(movedBy(map, x_px, y_px, 2)).front());
    EXPECT_EQ(assembler.unknownCells(), 1200U) << x_px << " " << y_px;
  }
}

TEST(MapAssembler, BeginsAnewWithAnotherMapAndWithAnotherGrid)
{
  MapAssembler assembler;
  for (const vessel_map_t& tile : tilesOf(mapOf(0, 0, 40, 40))) assembler.add(tile);
  assembler.add(tilesOf(mapOf(0, 0, 40, 40), 2).front());
  EXPECT_EQ(assembler.mapId(), 2);
  EXPECT_EQ(assembler.unknownCells(), 1200U);

  VesselMap shifted = mapOf(0, 0, 40, 40, 9);
  shifted.origin_x += 0.7;
  assembler.add(tilesOf(shifted, 2).back());
  EXPECT_EQ(assembler.unknownCells(), 1200U);
  EXPECT_EQ(assembler.map().seen.front(), 0);
}

TEST(MapAssembler, RefusesAnOlderVersionOfItsMap)
{
  MapAssembler assembler;
  EXPECT_EQ(assembler.add(tilesOf(mapOf(0, 0, 40, 40, 5)).front()), Reason::none);
  EXPECT_EQ(assembler.add(tilesOf(mapOf(0, 0, 40, 40, 4)).front()), Reason::out_of_order);
}

TEST(VesselMapMessage, LiesInsideAMapOfPossibleSize)
{
  const vessel_map_t good = tilesOf(mapOf(0, 0, 40, 40)).back();
  vessel_map_t tile{};
  EXPECT_EQ(read(good, tile), Reason::none);
  const auto refusal = [&](auto change) {
    vessel_map_t bad = good;
    change(bad);
    return read(bad, tile);
  };
  EXPECT_EQ(refusal([](vessel_map_t& t) { t.column = 21; }), Reason::out_of_range);
  EXPECT_EQ(refusal([](vessel_map_t& t) { t.row = -1; }), Reason::out_of_range);
  EXPECT_EQ(refusal([](vessel_map_t& t) { t.width = 10; }), Reason::out_of_range);
  EXPECT_EQ(refusal([](vessel_map_t& t) { t.map_width = t.map_height = 1 << 30; }), Reason::out_of_range);
  EXPECT_EQ(refusal([](vessel_map_t& t) { t.px_per_cell = 0.0; }), Reason::out_of_range);
  EXPECT_EQ(refusal([](vessel_map_t& t) { t.origin_x_px = HUGE_VAL; }), Reason::not_finite);
}

}  // namespace
}  // namespace eyeslam::messaging
