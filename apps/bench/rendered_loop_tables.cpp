// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/rendered_loop_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/error_text.h"
#include "command_line/progress.h"
#include "eyeslam/trials/error_figures.h"
#include "eyeslam/trials/loop_conditions.h"
#include "eyeslam/trials/rendered_trial.h"

namespace eyeslam::apps {

using trials::ErrorFigures;
using trials::RenderedResult;
using trials::RenderedTrialSetting;

namespace {

constexpr double kMicro = 1e-6;
constexpr const char* kCondition = "human";

struct HoldCase {
  const char *motion, *camera, *null_at, *study, *bound;
};
constexpr HoldCase kHolds[] = {{"in_situ", "30/20", "servo", "18.1 / 13.5 / 29", "20 / 15 / 33"},
                               {"in_situ", "120/5", "servo", "14.1 / 11.3 / 25", "16 / - / 27"},
                               {"in_situ", "120/5", "controller", "11.7 / 9.3 / 20", "13 / - / 23"},
                               {"saccade", "30/20", "servo", "99 / 13.9 / 34", ""},
                               {"in_situ", "30/20", "controller", "16.4 / 12.0 / 26", ""},
                               {"saccade", "120/5", "servo", "", ""}};

// Seeds on all cores: each trial is one thread's and knows nothing of the others.
std::vector<RenderedResult> run(const RenderedTrialSetting& setting, const LoopInputs& inputs, const std::string& name)
{
  std::vector<RenderedResult> results(static_cast<std::size_t>(inputs.seeds));
  std::atomic<std::size_t> next{0}, done{0};
  const auto work = [&] {
    for (std::size_t seed = next++; seed < results.size(); seed = next++) {
      results[seed] = trials::holdOnRenderedFrames(setting, seed);
      ++done;
    }
  };
  std::vector<std::future<void>> workers;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
    workers.push_back(std::async(std::launch::async, work));
  Progress progress(name, inputs.seeds, inputs.quiet ? Verbosity::quiet : Verbosity::normal);
  for (std::future<void>& worker : workers) {
    while (worker.wait_for(std::chrono::milliseconds(200)) != std::future_status::ready)
      progress.show(static_cast<std::int64_t>(done));
    worker.get();
  }
  return results;
}

// What went wrong, each kind once.
std::string stops(const std::vector<RenderedResult>& results)
{
  std::vector<std::string> kinds;
  std::size_t count = 0;
  for (const RenderedResult& result : results) {
    for (const trials::Obstacle& obstacle : result.obstacles) {
      ++count;
      const std::string kind = obstacle.state + " " + obstacle.reason;
      if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
    }
  }
  return count == 0 ? "none" : fmt::format("{} ({})", count, fmt::join(kinds, ", "));
}

struct Line {
  std::vector<ErrorFigures> tips, poses;
  trials::RecoveryCount recoveries;
  double fastest = 0.0, worst_pivot = 0.0;  // m/s, m
  int frames = 0, tracked = 0;

  Line(const RenderedTrialSetting& setting, const std::vector<RenderedResult>& results)
  {
    const trials::RecoveryTiming timing{1e-3 * setting.vision.latency_high_ms, 1.0 / setting.hardware.camera.fps,
                                        1e-3 * setting.servo.cycle.limits.speed_mm_s};
    for (const RenderedResult& result : results) {
      tips.push_back(inMicrometres(result.errors_m));
      poses.push_back(inMicrometres(result.pose_errors_m));
      trials::countRecoveries(timing, result.jumps, recoveries);
      fastest = std::max(fastest, result.highest_tip_speed);
      worst_pivot = std::max(worst_pivot, result.worst_pivot_error);
      frames += result.frames;
      tracked += result.tracked;
    }
  }
};

std::string share(int part, int whole) { return fmt::format("{} of {}", part, whole); }

void printLine(const HoldCase& c, const Line& line, const std::string& stopped)
{
  const trials::RecoveryCount& jumps = line.recoveries;
  fmt::print("| {} | {} | {} | {} | {} | {} | {:.1f} / {:.1f} | {} | {:.0f} mm/s | {:.0f} | {} | {} |\n", c.motion,
             c.camera, c.null_at, said(trials::overSeeds(line.tips)), c.study, c.bound,
             trials::overSeeds(line.poses).mean.rms, trials::overSeeds(line.poses).mean.p99,
             share(line.tracked, line.frames), 1e3 * line.fastest, line.worst_pivot / kMicro,
             jumps.jumps == 0 ? "" : share(jumps.in_time, jumps.jumps) + ", " + share(jumps.whole_in_time, jumps.whole),
             stopped);
}

}  // namespace

void printRenderedLoopTables(const LoopInputs& inputs)
{
  fmt::print(
      "\n| motion | camera | null subtracted by the | tip RMS ± spread / median / 95 % | loop study | bound | pose RMS "
      "/ "
      "99 % | frames tracked | fastest tip | worst pivot | back in time after a jump; of those without a refused frame "
      "| "
      "stops |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const HoldCase& c : kHolds) {
    RenderedTrialSetting setting = trials::renderedSetting(c.motion, c.camera, kCondition);
    setting.duration_s = inputs.seconds;
    setting.servo.cycle.null_at = c.null_at;
    const auto results = run(setting, inputs, fmt::format("rendered, {}, {}, {}", c.motion, c.camera, c.null_at));
    printLine(c, Line(setting, results), stops(results));
  }
  RenderedTrialSetting bare = trials::renderedSetting("in_situ", "30/20", kCondition);
  bare.duration_s = inputs.seconds;
  bare.aided = false;
  const Line line(bare, run(bare, inputs, "unaided"));
  fmt::print("| in_situ | none | unaided hand | {} | 233 / 192 / 407 | | | | | | | |\n",
             said(trials::overSeeds(line.tips)));
}

}  // namespace eyeslam::apps
