// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/loop_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bench/error_text.h"
#include "command_line/progress.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/trials/loop_conditions.h"
#include "eyeslam/trials/trace_task.h"

namespace eyeslam::apps {

using trials::ErrorFigures;
using trials::LoopResult;
using trials::LoopTask;
using trials::LoopTrialSetting;
using trials::SeedFigures;

namespace {

using TaskOfSeed = std::function<LoopTask(std::uint64_t seed)>;

LoopTask hold(std::uint64_t /*seed*/) { return trials::holdTask(trials::workingPlace()); }

/// The trials of one line of a table.
class Line {
 public:
  Line(const LoopInputs& inputs, const std::string& name, LoopTrialSetting setting, const TaskOfSeed& task = hold)
      : setting_(std::move(setting))
  {
    setting_.duration_s = inputs.seconds;
    Progress progress(name, inputs.seeds, inputs.quiet ? Verbosity::quiet : Verbosity::normal);
    for (int i = 0; i < inputs.seeds; ++i) {
      const auto seed = static_cast<std::uint64_t>(i);
      add(trials::runLoopTrial(setting_, task(seed), seed));
      progress.show(i + 1);
    }
  }

  SeedFigures all() const { return trials::overSeeds(all_); }
  SeedFigures calm() const { return trials::overSeeds(calm_); }
  const trials::RecoveryCount& recoveries() const { return recoveries_; }

 private:
  void add(const LoopResult& result)
  {
    std::vector<double> calm;
    for (std::size_t i = 0; i < result.errors_m.size(); ++i)
      if (result.calm[i]) calm.push_back(result.errors_m[i]);
    all_.push_back(inMicrometres(result.errors_m));
    calm_.push_back(inMicrometres(calm));
    trials::countRecoveries(trials::recoveryTiming(setting_), result.jumps, recoveries_);
  }

  LoopTrialSetting setting_;
  std::vector<ErrorFigures> all_, calm_;
  trials::RecoveryCount recoveries_;
};

void heading(const std::string& title, const std::vector<std::string>& columns)
{
  fmt::print("\n{}\n\n|", title);
  for (const std::string& column : columns) fmt::print(" {} |", column);
  fmt::print("\n|");
  for (std::size_t i = 0; i < columns.size(); ++i) fmt::print(" --- |");
  fmt::print("\n");
}

struct HoldCase {
  const char *motion, *camera, *null_at, *study, *bound;
};
constexpr HoldCase kHolds[] = {{"in_situ", "30/20", "servo", "18.1 / 13.5 / 29", "20 / 15 / 33"},
                               {"in_situ", "120/5", "servo", "14.1 / 11.3 / 25", "16 / - / 27"},
                               {"in_situ", "true", "servo", "13.4 / 10.9 / 24", "15"},
                               {"in_situ", "30/20", "controller", "16.4 / 12.0 / 26", ""},
                               {"in_situ", "120/5", "controller", "11.7 / 9.3 / 20", "13 / - / 23"},
                               {"in_situ", "true", "controller", "10.9 / 8.8 / 19", "12"},
                               {"paper", "30/20", "servo", "21.0 / 15.8 / 35", ""},
                               {"jerky", "30/20", "servo", "34.7 / 14.0 / 37", ""},
                               {"jerky", "120/5", "servo", "15.4 / 11.5 / 27", ""},
                               {"saccade", "30/20", "servo", "99 / 13.9 / 34", ""}};

void printHolds(const LoopInputs& inputs)
{
  heading("Hold a point of the retina: RMS ± spread over seeds / median / 95 %, um.",
          {"motion", "camera", "null subtracted by the", "this", "loop study", "bound"});
  for (const HoldCase& c : kHolds) {
    LoopTrialSetting setting = trials::loopSetting(c.motion, c.camera);
    setting.servo.null_at = c.null_at;
    const Line line(inputs, fmt::format("hold, {}, {}, {}", c.motion, c.camera, c.null_at), setting);
    fmt::print("| {} | {} | {} | {} | {} | {} |\n", c.motion, c.camera, c.null_at, said(line.all()), c.study, c.bound);
  }
  LoopTrialSetting bare = trials::loopSetting("in_situ", "30/20");
  bare.aided = false;
  fmt::print("| in_situ | none | unaided hand | {} | 233 / 192 / 407 | |\n", said(Line(inputs, "unaided", bare).all()));
}

void printLeftOut(const LoopInputs& inputs)
{
  heading("Each part left out, hold in situ: RMS ± spread / median / 95 %, um; in brackets the study's RMS.",
          {"left out", "30/20", "120/5"});
  for (const trials::LeftOut& part : trials::leftOut()) {
    fmt::print("| {} |", part.part);
    for (const char* camera : {"30/20", "120/5"}) {
      LoopTrialSetting setting = trials::loopSetting("in_situ", camera);
      part.leaveOut(setting);
      const Line line(inputs, fmt::format("without {}, {}", part.part, camera), setting);
      const double study = std::string(camera) == "30/20" ? part.study_30_20_um : part.study_120_5_um;
      fmt::print(" {}{} |", said(line.all()), study > 0.0 ? fmt::format(" ({})", study) : "");
    }
    fmt::print("\n");
  }
}

void printSaccades(const LoopInputs& inputs)
{
  heading("After a saccade: back under 50 um within latency + frame + way / goal speed + 40 ms of its onset.",
          {"camera", "in time", "of those without a refused frame", "median time back", "loop study", "bound"});
  for (const auto& [camera, study] : {std::pair{"30/20", "98.4 %"}, std::pair{"120/5", "96.9 %"}}) {
    trials::RecoveryCount count =
        Line(inputs, fmt::format("saccades, {}", camera), trials::loopSetting("saccade", camera)).recoveries();
    std::sort(count.seconds.begin(), count.seconds.end());
    const double median = count.seconds.empty() ? 0.0 : count.seconds[count.seconds.size() / 2];
    fmt::print("| {} | {} of {} ({:.1f} %) | {} of {} | {:.0f} ms | {} | 95 %, all without a refused frame |\n", camera,
               count.in_time, count.jumps, 100.0 * count.in_time / std::max(count.jumps, 1), count.whole_in_time,
               count.whole, 1e3 * median, study);
  }
}

void printSteps()
{
  heading("A step of the goal, without tremor and noise; bounds: 2 %, 10 ms after the time that its way takes.",
          {"step", "goal speed", "overshoot", "within 5 % after way / speed +"});
  for (const double speed_mm_s : {10.0, 20.0, 30.0}) {
    for (const double step_um : {50.0, 300.0, 1000.0}) {
      const trials::StepResponse response = trials::stepResponse(step_um * kMicro, speed_mm_s);
      fmt::print("| {:.0f} um | {:.0f} mm/s | {:.2f} % | {:.1f} ms |\n", step_um, speed_mm_s,
                 100.0 * response.overshoot, 1e3 * response.late_s);
    }
  }
}

struct TraceCase {
  const char *motion, *aid, *camera, *study, *bound;
  double lambda;
  bool aided;
};
constexpr TraceCase kTraces[] = {{"in_situ", "none", "none", "162", "", 0.0, false},
                                 {"in_situ", "hard", "30/20", "13.0 / 7.7 / 23", "16 / 10 / 28", 0.0, true},
                                 {"in_situ", "hard", "120/5", "10.0 / 6.4 / 20", "12", 0.0, true},
                                 {"in_situ", "soft 0.1", "30/20", "27.6 / 18.5 / 53", "30", 0.1, true},
                                 {"jerky", "hard", "30/20", "24.6 / 8.1 / 28", "", 0.0, true},
                                 {"jerky", "hard", "120/5", "11.0 / 6.6 / 21", "14", 0.0, true},
                                 {"jerky", "soft 0.1", "30/20", "37.3 / 21.9 / 65", "", 0.1, true},
                                 {"saccade", "hard", "30/20", "66 / 8.0 / 27", "", 0.0, true},
                                 {"saccade", "hard", "120/5", "46 / 6.6 / 22", "", 0.0, true}};

void printTraces(const LoopInputs& inputs)
{
  heading(
      "Trace a vessel at 0.4 mm/s: distance to its centreline, RMS ± spread / median / 95 %, um; `calm`: later than "
      "150 ms after a jerk (study: 13 / 32 at 30/20, 10 / 27 at 120/5).",
      {"motion", "fixture", "camera", "this", "calm RMS / 99 %", "loop study", "bound"});
  for (const TraceCase& c : kTraces) {
    LoopTrialSetting setting = trials::loopSetting(c.motion, c.aided ? c.camera : "30/20");
    setting.aided = c.aided;
    const TaskOfSeed task = [&c](std::uint64_t seed) { return trials::traceTask(seed, c.lambda); };
    const Line line(inputs, fmt::format("trace, {}, {}, {}", c.motion, c.aid, c.camera), setting, task);
    fmt::print("| {} | {} | {} | {} | {:.1f} / {:.0f} | {} | {} |\n", c.motion, c.aid, c.camera, said(line.all()),
               line.calm().mean.rms, line.calm().mean.p99, c.study, c.bound);
  }
}

}  // namespace

void printLoopTables(const LoopInputs& inputs)
{
  printHolds(inputs);
  printLeftOut(inputs);
  printSaccades(inputs);
  printSteps();
  printTraces(inputs);
}

}  // namespace eyeslam::apps
