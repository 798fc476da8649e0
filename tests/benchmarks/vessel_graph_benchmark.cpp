// SPDX-License-Identifier: GPL-3.0-or-later
// Wanted (issue 14): the whole of 2000 x 1500 cells under 50 ms, the surroundings of a tip under 1 ms.
#include <benchmark/benchmark.h>

#include <random>

#include "eyeslam/fixtures/vessel_graph.h"
#include "support/drawn_vessels.h"

namespace {

using namespace eyeslam;

/// Twenty trees: about as many vessels as a photograph of the whole fundus shows.
const retina::VesselMap& wholeFundus()
{
  static const retina::VesselMap map = [] {
    support::DrawnVessels whole(2000, 1500);
    for (unsigned tile = 0; tile < 20; ++tile) {
      std::mt19937_64 random(tile);
      const int left = static_cast<int>(tile % 5) * 400, top = static_cast<int>(tile / 5) * 375;
      support::DrawnVessels part(400, 375);
      support::drawTree(part, random);
      for (int row = 0; row < 375; ++row) {
        for (int column = 0; column < 400; ++column) {
          whole.map().probability[whole.map().index(left + column, top + row)] =
              part.map().probability[part.map().index(column, row)];
        }
      }
    }
    return whole.map();
  }();
  return map;
}

void wholeMap(benchmark::State& state)
{
  wholeFundus();  // drawn outside of the measurement
  for (auto _ : state) {
    fixtures::VesselGraph graph;
    graph.update(wholeFundus());
    benchmark::DoNotOptimize(graph.vessels().data());
  }
}
BENCHMARK(wholeMap)->Unit(benchmark::kMillisecond);

// One block of the published map changes, as after a frame.
void updateOfABlock(benchmark::State& state)
{
  retina::VesselMap map = wholeFundus();
  fixtures::VesselGraph graph;
  graph.update(map);
  for (auto _ : state) {
    for (int row = 700; row < 828; ++row) {
      for (int column = 900; column < 1028; ++column) {
        std::uint8_t& cell = map.probability[map.index(column, row)];
        if (cell > 0 && cell < 255) cell ^= 8U;
      }
    }
    graph.update(map);
    benchmark::DoNotOptimize(graph.vessels().data());
  }
}
BENCHMARK(updateOfABlock)->Unit(benchmark::kMillisecond);

void surroundingsOfATip(benchmark::State& state)
{
  const Eigen::AlignedBox2d region(Eigen::Vector2d(900.0, 700.0), Eigen::Vector2d(1028.0, 828.0));
  for (auto _ : state) benchmark::DoNotOptimize(fixtures::extractVessels(wholeFundus(), region));
}
BENCHMARK(surroundingsOfATip)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
