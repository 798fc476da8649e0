// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-bench: this tracker beside the alternatives, as tables (contracts, section 2).
#include <fmt/format.h>

#include <filesystem>

#include "bench/centerline_study.h"
#include "bench/detector_study.h"
#include "bench/live_study.h"
#include "bench/loop_tables.h"
#include "bench/method_study.h"
#include "bench/plan_tables.h"
#include "bench/rendered_loop_tables.h"
#include "command_line/program.h"
#include "command_line/progress.h"
#include "eyeslam/baselines/method.h"

namespace {

using namespace eyeslam::apps;

const std::string kExamples =
    "eyeslam-bench accuracy sequences/paper sequences/human --methods eyeslam,paper\n"
    "eyeslam-bench speed sequences/human\n"
    "eyeslam-bench detect sequences/*\n"
    "eyeslam-bench centerlines photographs/*_vessels.png\n"
    "eyeslam-bench centerlines sequences/human --tracks out\n"
    "eyeslam-bench plan sequences/* --tracks out --photographs photographs\n"
    "eyeslam-bench loop --seeds 5\n"
    "eyeslam-bench live --seconds 600";

struct BenchArguments {
  std::vector<std::string> sequences;
  std::vector<std::string> methods = eyeslam::baselines::methodNames();
  int frames = 0;
  int period = 30;
  bool quiet = false;
};

std::string nameOf(const std::string& sequence)
{
  const std::filesystem::path path = std::filesystem::path(sequence).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

// Runs every method over every sequence; `row` prints one line of the table.
template <class Row>
void forEachRun(const BenchArguments& arguments, Row&& row)
{
  for (const std::string& sequence : arguments.sequences) {
    for (const std::string& method : arguments.methods) {
      Progress progress(nameOf(sequence) + ", " + method, std::nullopt,
                        arguments.quiet ? Verbosity::quiet : Verbosity::normal);
      const auto step = [&](std::int64_t frame) { progress.show(frame + 1); };
      row(nameOf(sequence), method, scoreMethod(method, sequence, arguments.frames, step));
    }
  }
}

void accuracy(const BenchArguments& arguments)
{
  fmt::print("| sequence | method | RMS px | RMS deg | worst px | under 5 px | tracked | CPU ms, median | p99 |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  forEachRun(arguments, [](const auto& sequence, const auto& method, const auto& score) {
    fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.2f} | {:.1f} % | {:.1f} % | {:.2f} | {:.2f} |\n", sequence, method,
               score.rms_px, score.rms_deg, score.max_px, 100.0 * score.under_5_px, 100.0 * score.tracked,
               score.cpu_ms_median, score.cpu_ms_p99);
  });
}

void speed(const BenchArguments& arguments)
{
  fmt::print("| sequence | method | CPU ms, median | p99 | frames/s of one core |\n");
  fmt::print("| --- | --- | --- | --- | --- |\n");
  forEachRun(arguments, [](const auto& sequence, const auto& method, const auto& score) {
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.0f} |\n", sequence, method, score.cpu_ms_median, score.cpu_ms_p99,
               1000.0 / score.cpu_ms_median);
  });
}

void detect(const BenchArguments& arguments)
{
  fmt::print("| sequence | detector | points | on a vessel | coverage | from 6 px | CPU us |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- |\n");
  for (const std::string& detector : detectorNames()) {
    DetectorScore mean;
    const auto share = 1.0 / static_cast<double>(arguments.sequences.size());
    const auto print = [&](const std::string& sequence, const DetectorScore& score) {
      fmt::print("| {} | {} | {:.0f} | {:.1f} % | {:.1f} % | {:.1f} % | {:.0f} |\n", sequence, detector, score.points,
                 100.0 * score.on_vessel, 100.0 * score.coverage, 100.0 * score.coverage_from_6_px, score.cpu_us);
    };
    for (const std::string& sequence : arguments.sequences) {
      const DetectorScore score = scoreDetector(detector, sequence, arguments.period);
      print(nameOf(sequence), score);
      mean.points += share * score.points;
      mean.on_vessel += share * score.on_vessel;
      mean.coverage += share * score.coverage;
      mean.coverage_from_6_px += share * score.coverage_from_6_px;
      mean.cpu_us += share * score.cpu_us;
    }
    print("mean", mean);
  }
}

CLI::App* addCommand(CLI::App& app, const std::string& name, const std::string& does, BenchArguments& arguments)
{
  CLI::App* command = app.add_subcommand(name, does);
  command->add_option("SEQUENCES", arguments.sequences, "folders with a video and its truth")
      ->required()
      ->check(CLI::ExistingDirectory);
  command->add_flag("--quiet", arguments.quiet, "no progress on standard error");
  return command;
}

CLI::App* addMethodCommand(CLI::App& app, const std::string& name, const std::string& does, BenchArguments& arguments)
{
  CLI::App* command = addCommand(app, name, does, arguments);
  command->add_option("--methods", arguments.methods, "which methods, separated by commas; default all")
      ->delimiter(',')
      ->check(CLI::IsMember(eyeslam::baselines::methodNames()));
  command->add_option("--frames", arguments.frames, "at most so many frames of each; 0 = all")
      ->check(CLI::Range(0, 1000000));
  return command;
}

CLI::App* addCenterlineCommand(CLI::App& app, CenterlineInputs& inputs)
{
  CLI::App* command = app.add_subcommand("centerlines", "vessel graphs against hand-drawn masks or labelled vessels");
  command->add_option("KNOWN", inputs.known, "masks (pictures), or folders with truth")
      ->required()
      ->check(CLI::ExistingPath);
  command->add_option("--tracks", inputs.tracks, "folder with what eyeslam-track wrote of each sequence, by its name")
      ->check(CLI::ExistingDirectory);
  command->add_flag("--quiet", inputs.quiet, "no progress on standard error");
  return command;
}

CLI::App* addPlanCommand(CLI::App& app, PlanInputs& inputs)
{
  CLI::App* command = app.add_subcommand("plan", "burn plans against the vessels of their maps and the true ones");
  command->add_option("SEQUENCES", inputs.sequences, "folders with truth")->required()->check(CLI::ExistingDirectory);
  command->add_option("--tracks", inputs.tracks, "folder with what eyeslam-track wrote of each, by its name")
      ->required()
      ->check(CLI::ExistingDirectory);
  command->add_option("--photographs", inputs.photographs, "folder with NAME.jpg and NAME_vessels.png")
      ->check(CLI::ExistingDirectory);
  command->add_option("--um-per-px", inputs.um_per_px, "of the photographs")->check(CLI::Range(0.3, 50.0));
  command->add_flag("--quiet", inputs.quiet, "no progress on standard error");
  return command;
}

CLI::App* addLoopCommand(CLI::App& app, LoopInputs& inputs)
{
  CLI::App* command = app.add_subcommand("loop", "the 1 kHz loop in lock-step trials, beside the loop study");
  command->add_option("--seeds", inputs.seeds, "trials a line")->check(CLI::Range(1, 10000));
  command->add_option("--seconds", inputs.seconds, "that count, of each")->check(CLI::Range(1.0, 3600.0));
  command->add_flag("--rendered", inputs.rendered, "the real tracker on rendered frames instead of assumed noise");
  command->add_flag("--quiet", inputs.quiet, "no progress on standard error");
  return command;
}

CLI::App* addLiveCommand(CLI::App& app, LiveInputs& inputs)
{
  CLI::App* command = app.add_subcommand("live", "eyeslam-servo as a process over UDP, beside a bare timer loop");
  command->add_option("--seconds", inputs.seconds, "that count")->check(CLI::Range(1.0, 1800.0));
  command->add_option("--programs", inputs.programs, "folder of eyeslam-servo and eyeslam-track; default: beside this")
      ->check(CLI::ExistingDirectory);
  command->add_flag("--quiet", inputs.quiet, "no progress on standard error");
  return command;
}

std::function<void()> setUp(CLI::App& app, BenchArguments& arguments, PlanInputs& plans, CenterlineInputs& lines,
                            LoopInputs& loops, LiveInputs& live)
{
  addStandardOptions(app, kExamples);
  app.require_subcommand(1);
  const CLI::App* by_accuracy =
      addMethodCommand(app, "accuracy", "errors of tracking methods against the truth", arguments);
  const CLI::App* by_speed = addMethodCommand(app, "speed", "CPU time of tracking methods a frame", arguments);
  CLI::App* by_detector = addCommand(app, "detect", "vessel detectors against labelled vessels", arguments);
  by_detector->add_option("--period", arguments.period, "looks at one frame in so many")->check(CLI::Range(1, 10000));
  const CLI::App* by_plan = addPlanCommand(app, plans);
  const CLI::App* by_line = addCenterlineCommand(app, lines);
  const CLI::App* by_loop = addLoopCommand(app, loops);
  const CLI::App* by_process = addLiveCommand(app, live);
  return [by_accuracy, by_speed, by_plan, by_line, by_loop, by_process, &arguments, &plans, &lines, &loops, &live] {
    if (by_accuracy->parsed()) return accuracy(arguments);
    if (by_speed->parsed()) return speed(arguments);
    if (by_line->parsed()) return printCenterlines(lines);
    if (by_plan->parsed()) return printPlanTables(plans);
    if (by_loop->parsed()) return loops.rendered ? printRenderedLoopTables(loops) : printLoopTables(loops);
    if (by_process->parsed()) return printLiveTable(live);
    detect(arguments);
  };
}

}  // namespace

int main(int argc, char** argv)
{
  BenchArguments arguments;
  PlanInputs plans;
  CenterlineInputs lines;
  LoopInputs loops;
  LiveInputs live;
  return runProgram("eyeslam-bench",
                    "Compares this tracker, and its parts, with the alternatives; prints Markdown tables.", argc, argv,
                    [&](CLI::App& app) { return setUp(app, arguments, plans, lines, loops, live); });
}
