// SPDX-License-Identifier: GPL-3.0-or-later
// Planning a map of 2000 x 1500 cells: some 1500 burns of 100 um among branching vessels. Wanted: 100 ms without order.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "eyeslam/fixtures/burn_lattice.h"
#include "eyeslam/fixtures/burn_planner.h"
#include "eyeslam/retina/map_hash.h"

using namespace eyeslam;

namespace {

void drawLine(retina::VesselMap& map, double x, double y, double angle, int length, int half_width)
{
  for (int step = 0; step < length; ++step, x += std::cos(angle), y += std::sin(angle)) {
    angle += 0.01 * std::sin(0.02 * step);
    for (int dy = -half_width; dy <= half_width; ++dy) {
      for (int dx = -half_width; dx <= half_width; ++dx) {
        const int column = static_cast<int>(x) + dx, row = static_cast<int>(y) + dy;
        if (column < 0 || row < 0 || column >= map.width || row >= map.height) continue;
        map.probability[map.index(column, row)] = 255;
      }
    }
  }
}

retina::VesselMap largeMap()
{
  retina::VesselMap map;
  map.width = 2000;
  map.height = 1500;
  map.um_per_px = 6.5;
  map.probability.assign(map.index(0, map.height), 0);
  map.seen.assign(map.probability.size(), 200);
  std::mt19937 random(1);
  const auto uniform = [&](double highest) { return std::uniform_real_distribution<double>(0.0, highest)(random); };
  for (int vessel = 0; vessel < 40; ++vessel) {
    drawLine(map, uniform(2000.0), uniform(1500.0), uniform(6.28), 900, static_cast<int>(1.0 + uniform(6.0)));
  }
  return map;
}

fixtures::BurnPrescription hexagons()
{
  fixtures::BurnPrescription prescription;
  prescription.pattern.kind = "hexagonal";
  prescription.pattern.spacing_um = 215.0;
  prescription.safety.rescue_um = 0.0;
  return prescription;
}

void planOn2000x1500(benchmark::State& state)
{
  const retina::VesselMap map = largeMap();
  std::size_t valid = 0;
  for ([[maybe_unused]] auto _ : state) valid = fixtures::validTargets(fixtures::planBurns(map, hexagons()));
  state.counters["burns"] = static_cast<double>(valid);
}

void planAndRescueOn2000x1500(benchmark::State& state)
{
  const retina::VesselMap map = largeMap();
  fixtures::BurnPrescription prescription = hexagons();
  prescription.safety.rescue_um = 200.0;
  std::size_t valid = 0;
  for ([[maybe_unused]] auto _ : state) valid = fixtures::validTargets(fixtures::planBurns(map, prescription));
  state.counters["burns"] = static_cast<double>(valid);
}

void revalidateOn2000x1500(benchmark::State& state)
{
  const retina::VesselMap map = largeMap();
  const fixtures::BurnPlan plan = fixtures::planBurns(map, hexagons());
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(fixtures::revalidated(plan, map));
}

void hashOf2000x1500(benchmark::State& state)
{
  const retina::VesselMap map = largeMap();
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(retina::hashOf(map));
}

BENCHMARK(planOn2000x1500)->Unit(benchmark::kMillisecond);
BENCHMARK(planAndRescueOn2000x1500)->Unit(benchmark::kMillisecond);
BENCHMARK(revalidateOn2000x1500)->Unit(benchmark::kMillisecond);
BENCHMARK(hashOf2000x1500)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
