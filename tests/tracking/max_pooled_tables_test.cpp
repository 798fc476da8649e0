// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/max_pooled_tables.h"

#include <gtest/gtest.h>

#include <random>

#include "eyeslam/tracking/whole_map_tables.h"
#include "support/vessel_scenes.h"

using namespace eyeslam;
using namespace eyeslam::tracking;

namespace {

int cellAt(const MaxPooledTables& tables, int x, int y)
{
  if (x < 0 || y < 0 || x >= tables.size().width || y >= tables.size().height) return 0;
  return tables.cells()[x + y * tables.stride()];
}

int largestIn(const MaxPooledTables& tables, int x, int y, int side)
{
  int most = 0;
  for (int row = y; row < y + side; ++row) {
    for (int column = x; column < x + side; ++column) most = std::max(most, cellAt(tables, column, row));
  }
  return most;
}

void expectMaxima(const MaxPooledTables& tables)
{
  for (int y = 0; y < tables.size().height; ++y) {
    for (int x = 0; x < tables.size().width; ++x) {
      ASSERT_EQ(tables.smallBounds()[x + y * tables.stride()], largestIn(tables, x, y, 4)) << x << ", " << y;
      const int sixteenths = (largestIn(tables, x, y, 8) + 15) / 16;
      ASSERT_EQ(tables.bounds()[tables.boundOffset(x, y)], sixteenths) << x << ", " << y;
    }
  }
}

TEST(MaxPooledTables, HoldTheMaximaOfTheirWindowsCellByCell)
{
  std::mt19937 random(1);
  MaxPooledTables tables;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const auto side = [&] { return std::uniform_int_distribution<int>(1, 90)(random); };
    tables.resize({side(), side()});
    std::bernoulli_distribution is_hit(0.02 * (i % 10));
    for (int y = 0; y < tables.size().height; ++y) {
      for (int x = 0; x < tables.size().width; ++x) {
        tables.row(y)[x] = static_cast<std::uint8_t>(is_hit(random) ? random() % 256 : 0);
      }
    }
    tables.pool();
    expectMaxima(tables);
  }
}

TEST(MaxPooledTables, PutBoundsOfNeighbouringBlocksSideBySide)
{
  MaxPooledTables tables;
  tables.resize({100, 60});
  EXPECT_EQ(tables.boundOffset(3 + 8, 5), tables.boundOffset(3, 5) + 1);
  EXPECT_EQ(tables.boundOffset(3, 5 + 8), tables.boundOffset(3, 5) + tables.boundStride());
}

TEST(MaxPooledTables, CopyTheMap)
{
  OccupancyMap map;
  map.add({{-7.0F, 3.0F}, {90.0F, -200.0F}}, {});
  MaxPooledTables tables;
  tables.assign(map, {-20, -110, 80, 140});
  for (int y = 0; y < 140; ++y) {
    for (int x = 0; x < 80; ++x) ASSERT_EQ(cellAt(tables, x, y), map.cell(x - 20, y - 110));
  }
}

TEST(WholeMapTables, MadeInSlicesAreThoseMadeAtOnceAndFollowTheMap)
{
  std::mt19937 random(2);
  OccupancyMap map;
  map.add(support::randomVessels(random, 20, 500.0), {});
  for (const int reduction : {1, 2, 3}) {
    SCOPED_TRACE(reduction);
    WholeMapTables sliced;
    for (int change = 0; change < 3; ++change) {
      map.add(support::randomVessels(random, 1, 500.0), {});
      int slices = 1;
      while (!sliced.update(map, reduction, 20, 1)) ++slices;
      EXPECT_GT(slices, 1);
      const MaxPooledTables& tables = sliced.tables();
      const cv::Point origin = sliced.origin();
      for (int y = 0; y < tables.size().height; ++y) {
        for (int x = 0; x < tables.size().width; ++x) {
          int most = 0;
          for (int n = 0; n < reduction * reduction; ++n) {
            most = std::max<int>(
                most, map.cell((origin.x + x) * reduction + n % reduction, (origin.y + y) * reduction + n / reduction));
          }
          ASSERT_EQ(cellAt(tables, x, y), most);
        }
      }
      expectMaxima(tables);
      EXPECT_TRUE(sliced.update(map, reduction, 20, 0));  // nothing to do
    }
  }
}

}  // namespace
