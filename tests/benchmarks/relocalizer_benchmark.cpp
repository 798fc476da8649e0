// SPDX-License-Identifier: GPL-3.0-or-later
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <random>

#include "eyeslam/tracking/relocalizer.h"
#include "support/vessel_scenes.h"

using namespace eyeslam;
using namespace eyeslam::tracking;

namespace {

double threadMilliseconds()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Searches a map of side_px for views that are in it or (elsewhere) are not; reports the dearest call.
void relocalize(benchmark::State& state, double side_px, cv::Size view, bool elsewhere)
{
  std::mt19937 random(1);
  const int count = static_cast<int>(60.0 * side_px * side_px / (1200.0 * 1200.0) * 400.0 / view.width);
  const ScanPoints vessels = support::randomVessels(random, count, side_px);
  const ScanPoints others = support::randomVessels(random, count, side_px);
  OccupancyMap map;
  support::saturate(map, vessels);
  std::uniform_real_distribution<double> place(-side_px / 3, side_px / 3), angle(-0.2, 0.2);
  std::vector<ScanPoints> views;
  for (int i = 0; i < 20; ++i) {
    views.push_back(support::seenFrom({place(random), place(random), angle(random), 1.0}, elsewhere ? others : vessels,
                                      view.width, view.height, 500, 0.7, 0.15, random));
  }
  Relocalizer relocalizer;
  relocalizer.reserve(view);
  double most = 0.0, found = 0.0;
  double first = threadMilliseconds();
  int slices = 1;
  while (!relocalizer.prepare(map)) {
    most = std::max(most, threadMilliseconds() - first);
    first = threadMilliseconds();
    ++slices;
  }
  state.counters["slice_ms"] = most;
  state.counters["slices"] = slices;
  std::size_t next = 0;
  most = 0.0;
  for (auto _ : state) {
    const double start = threadMilliseconds();
    const MatchResult result = relocalizer.search(views[next++ % views.size()], map, {});
    most = std::max(most, threadMilliseconds() - start);
    found += result.reason == retina::Reason::none ? 1.0 : 0.0;
  }
  state.counters["most_ms"] = most;
  state.counters["found"] = found / static_cast<double>(state.iterations());
}

const cv::Size kNormal(400, 304), kLarge(960, 540);
void FindInThreeViews(benchmark::State& state) { relocalize(state, 1200.0, kNormal, false); }
void FindNothingInThreeViews(benchmark::State& state) { relocalize(state, 1200.0, kNormal, true); }
void FindInSixViews(benchmark::State& state) { relocalize(state, 2400.0, kNormal, false); }
void FindInFifteenViews(benchmark::State& state) { relocalize(state, 6000.0, kNormal, false); }
void FindNothingInFifteenViews(benchmark::State& state) { relocalize(state, 6000.0, kNormal, true); }
void FindInLargeViews(benchmark::State& state) { relocalize(state, 6000.0, kLarge, false); }

BENCHMARK(FindInThreeViews)->Unit(benchmark::kMillisecond);
BENCHMARK(FindNothingInThreeViews)->Unit(benchmark::kMillisecond);
BENCHMARK(FindInSixViews)->Unit(benchmark::kMillisecond);
BENCHMARK(FindInFifteenViews)->Unit(benchmark::kMillisecond);
BENCHMARK(FindNothingInFifteenViews)->Unit(benchmark::kMillisecond);
BENCHMARK(FindInLargeViews)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
