// SPDX-License-Identifier: GPL-3.0-or-later
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "eyeslam/tracking/scan_matcher.h"
#include "support/vessel_scenes.h"

using namespace eyeslam;
using namespace eyeslam::tracking;

namespace {

constexpr double kStep = 0.46 * M_PI / 180.0;  // the angular step of a 400 x 304 view

/// Vessels over 1200 x 1200 px, and views of 400 x 304 of them.
struct Scene {
  OccupancyMap map;
  std::vector<retina::Pose2> poses;
  std::vector<ScanPoints> views;

  explicit Scene(int points)
  {
    std::mt19937 random(1);
    const ScanPoints vessels = support::randomVessels(random, 60, 1200.0);
    support::saturate(map, vessels);
    std::uniform_real_distribution<double> place(-300.0, 300.0), angle(-0.2, 0.2);
    for (int i = 0; i < 50; ++i) {
      poses.push_back({place(random), place(random), angle(random), 1.0});
      views.push_back(support::seenFrom(poses.back(), vessels, 400, 304, points, 0.7, 0.15, random));
    }
  }
};

void matchAround(benchmark::State& state, int points, double off_px, double half_px, double half_theta)
{
  const Scene scene(points);
  ScanMatcher matcher;
  matcher.reserve({400, 304});
  std::size_t view = 0, found = 0;
  for (auto _ : state) {
    view = (view + 1) % scene.views.size();
    const retina::Pose2& pose = scene.poses[view];
    const SearchWindow window{
        {pose.x + off_px, pose.y - off_px, pose.theta + half_theta / 2, 1.0}, half_px, half_px, half_theta};
    found += matcher.search(scene.views[view], scene.map, window).reason == retina::Reason::none ? 1 : 0;
  }
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(state.iterations());
}

void MatchInTheNormalWindow(benchmark::State& state) { matchAround(state, 500, 3.0, 8.0, 2.0 * kStep); }
void MatchInTheWideWindow(benchmark::State& state) { matchAround(state, 250, 50.0, 80.0, 8.0 * kStep); }
void MatchNothingInTheWideWindow(benchmark::State& state) { matchAround(state, 250, 300.0, 80.0, 8.0 * kStep); }

BENCHMARK(MatchInTheNormalWindow)->Unit(benchmark::kMicrosecond);
BENCHMARK(MatchInTheWideWindow)->Unit(benchmark::kMicrosecond);
BENCHMARK(MatchNothingInTheWideWindow)->Unit(benchmark::kMicrosecond);

void AddPoints(benchmark::State& state)
{
  Scene scene(500);
  std::size_t view = 0;
  for (auto _ : state) {
    view = (view + 1) % scene.views.size();
    scene.map.add(scene.views[view], scene.poses[view]);
  }
}
BENCHMARK(AddPoints)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
