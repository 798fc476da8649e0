// SPDX-License-Identifier: GPL-3.0-or-later
#include <benchmark/benchmark.h>

#include "support/fixture_scene.h"

using namespace eyeslam;

namespace {

/// One cycle, by the number of trees in the map.
void evaluate(benchmark::State& state, support::Aid aid)
{
  support::FixtureScene scene(static_cast<int>(state.range(0)), aid);
  for (auto _ : state) benchmark::DoNotOptimize(scene.next().goal);
  state.counters["points"] = static_cast<double>(scene.points());
}
void Guide(benchmark::State& state) { evaluate(state, support::Aid::guided); }
void KeepOut(benchmark::State& state) { evaluate(state, support::Aid::kept_out); }
BENCHMARK(Guide)->Arg(20)->Arg(200);
BENCHMARK(KeepOut)->Arg(20)->Arg(200);

/// Freezing a map, outside the loop.
void Freeze(benchmark::State& state)
{
  std::mt19937 random(1);
  const support::RandomVessels grown = support::randomVesselGraph(random, static_cast<int>(state.range(0)), 1500.0);
  for (auto _ : state) benchmark::DoNotOptimize(fixtures::CenterlineIndex(grown.vessels, 5.0).empty());
}
BENCHMARK(Freeze)->Arg(6)->Arg(60)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
