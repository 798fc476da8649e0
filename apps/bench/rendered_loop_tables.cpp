// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/rendered_loop_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/error_text.h"
#include "command_line/progress.h"
#include "command_line/version.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/trials/error_figures.h"
#include "eyeslam/trials/loop_conditions.h"
#include "eyeslam/trials/trial.h"
#include "eyeslam/trials/trial_judge.h"

namespace eyeslam::apps {

using trials::ErrorFigures;

namespace {

constexpr double kFull = 2.0;  // full-resolution px a half-resolution one

struct RenderedHold {
  const char* motion;
  double camera_hz, latency_ms;
  const char *null_at, *study, *bound;
  const char* aid = "hard";
};
constexpr RenderedHold kRenderedHolds[] = {{"in_situ", 30, 20, "servo", "18.1 / 13.5 / 29", "20 / 15 / 33"},
                                           {"in_situ", 120, 5, "servo", "14.1 / 11.3 / 25", "16 / - / 27"},
                                           {"in_situ", 120, 5, "controller", "11.7 / 9.3 / 20", "13 / - / 23"},
                                           {"saccade", 30, 20, "servo", "99 / 13.9 / 34", ""},
                                           {"in_situ", 30, 20, "controller", "16.4 / 12.0 / 26", ""},
                                           {"saccade", 120, 5, "servo", "", ""}};
constexpr RenderedHold kBareHand = {"in_situ", 30, 20, "servo", "233 / 192 / 407", "", "none"};

trials::TrialSetting settingOf(const RenderedHold& c, double seconds)
{
  trials::Scenario scenario;
  scenario.name = "hold";
  scenario.task = "hold";
  scenario.aid = c.aid;
  scenario.motion = c.motion;
  scenario.camera_hz = c.camera_hz;
  scenario.latency_ms = c.latency_ms;
  scenario.null_at = c.null_at;
  scenario.duration_s = seconds;
  return trials::presetBy(scenario);
}

/// Of one seed, what the table says; a whole record would hold its retina too.
struct Held {
  ErrorFigures tip, pose;  // um
  std::vector<trials::Jump> jumps;
  std::vector<std::string> stops;
  double fastest = 0.0, worst_pivot = 0.0;  // m/s, m
  std::int64_t frames = 0, tracked = 0;
};

Held renderedHold(const trials::TrialSetting& setting, std::uint64_t seed)
{
  const auto scene = std::make_shared<const trials::TrialScene>(setting, seed);
  trials::TrialJudge judge(scene);
  trials::Trial trial(setting, {setting.scenario.name, setting.scenario.aid, seed}, kVersion, *scene,
                      [&judge](const files::LogEvent& event) { judge.take(event); });
  while (trial.step()) continue;
  const trials::TrialRecord record = judge.record();
  if (record.tip.empty()) throw std::runtime_error(fmt::format("seed {}: {}", seed, record.verdict));
  std::vector<double> errors_m, poses_m;
  for (const trials::TipSample& sample : record.tip) errors_m.push_back(sample.error);
  for (const double px : record.pose_errors_px) poses_m.push_back(kFull * px * kMicro * scene->umPerPx());
  Held held{inMicrometres(errors_m), inMicrometres(poses_m), record.jumps,  {},
            record.fastest_tip,      record.worst_pivot,     record.frames, record.tracked};
  for (const trials::TrialEvent& event : record.events)
    if (event.what == "hold" || event.what == "fault")
      held.stops.push_back(fmt::format("{} {} of seed {}", event.what, event.reason, seed));
  return held;
}

// Seeds on all cores: each trial is one thread's and knows nothing of the others.
std::vector<Held> run(const RenderedHold& c, const LoopInputs& inputs)
{
  const trials::TrialSetting setting = settingOf(c, inputs.seconds);
  std::vector<Held> results(static_cast<std::size_t>(inputs.seeds));
  std::atomic<std::size_t> next{0}, done{0};
  const auto work = [&] {
    for (std::size_t seed = next++; seed < results.size(); seed = next++) {
      results[seed] = renderedHold(setting, seed);
      ++done;
    }
  };
  std::vector<std::future<void>> workers;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
    workers.push_back(std::async(std::launch::async, work));
  Progress progress(
      fmt::format("rendered, {}, {}/{}, {}, aid {}", c.motion, c.camera_hz, c.latency_ms, c.null_at, c.aid),
      inputs.seeds, inputs.quiet ? Verbosity::quiet : Verbosity::normal);
  for (std::future<void>& worker : workers) {
    while (worker.wait_for(std::chrono::milliseconds(200)) != std::future_status::ready)
      progress.show(static_cast<std::int64_t>(done));
    worker.get();
  }
  return results;
}

struct RenderedLine {
  std::vector<ErrorFigures> tips, poses;
  trials::RecoveryCount recoveries;
  double fastest = 0.0, worst_pivot = 0.0;  // m/s, m
  std::int64_t frames = 0, tracked = 0;
  std::vector<std::string> kinds;  // of stops, each once
  std::size_t stops = 0;

  RenderedLine(const RenderedHold& c, const LoopInputs& inputs)
  {
    const trials::RecoveryTiming timing{1e-3 * c.latency_ms, 1.0 / c.camera_hz,
                                        1e-3 * settingOf(c, inputs.seconds).servo.cycle.limits.speed_mm_s};
    for (const Held& held : run(c, inputs)) {
      tips.push_back(held.tip);
      poses.push_back(held.pose);
      trials::countRecoveries(timing, held.jumps, recoveries);
      fastest = std::max(fastest, held.fastest);
      worst_pivot = std::max(worst_pivot, held.worst_pivot);
      frames += held.frames;
      tracked += held.tracked;
      stops += held.stops.size();
      for (const std::string& kind : held.stops)
        if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
    }
  }
  std::string stopped() const { return stops == 0 ? "none" : fmt::format("{} ({})", stops, fmt::join(kinds, ", ")); }
};

std::string share(std::int64_t part, std::int64_t whole) { return fmt::format("{} of {}", part, whole); }

void printLine(const RenderedHold& c, const RenderedLine& line)
{
  const trials::RecoveryCount& jumps = line.recoveries;
  fmt::print("| {} | {}/{} | {} | {} | {} | {} | {:.1f} / {:.1f} | {} | {:.0f} mm/s | {:.0f} | {} | {} |\n", c.motion,
             c.camera_hz, c.latency_ms, c.null_at, said(trials::overSeeds(line.tips)), c.study, c.bound,
             trials::overSeeds(line.poses).mean.rms, trials::overSeeds(line.poses).mean.p99,
             share(line.tracked, line.frames), 1e3 * line.fastest, line.worst_pivot / kMicro,
             jumps.jumps == 0 ? "" : share(jumps.in_time, jumps.jumps) + ", " + share(jumps.whole_in_time, jumps.whole),
             line.stopped());
}

}  // namespace

void printRenderedLoopTables(const LoopInputs& inputs)
{
  fmt::print(
      "\n| motion | camera | null subtracted by the | tip RMS ± spread / median / 95 % | loop study | bound | pose RMS "
      "/ 99 % | frames tracked | fastest tip | worst pivot | back in time after a jump; of those without a refused "
      "frame | stops |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const RenderedHold& c : kRenderedHolds) printLine(c, RenderedLine(c, inputs));
  fmt::print("| in_situ | none | unaided hand | {} | {} | | | | | | | |\n",
             said(trials::overSeeds(RenderedLine(kBareHand, inputs).tips)), kBareHand.study);
}

}  // namespace eyeslam::apps
