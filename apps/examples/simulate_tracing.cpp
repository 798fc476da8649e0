// SPDX-License-Identifier: GPL-3.0-or-later
// simulate_tracing: how far the goals of fixtures are off the vessel while a simulated hand traces it; a table.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "command_line/program.h"
#include "guidance/guided_tracing.h"
#include "guidance/tracing_score.h"

namespace {

using namespace eyeslam::apps;

const std::string kExamples = "simulate_tracing\nsimulate_tracing --seeds 100 --lambda 0.15";

struct Arguments {
  std::uint64_t seeds = 20;
  double seconds = 20.0;
  double lambda = 0.1;
};

void print(const Arguments& arguments)
{
  fmt::print(
      "| retina | unaided: RMS / median / p95 um | hard goal: RMS, largest in force um | soft goal: RMS / p95 um "
      "| most off lambda x distance, um | retina beyond 20 mm/s |\n| --- | --- | --- | --- | --- | --- |\n");
  for (const char* motion : {"in_situ", "jerky", "saccade", "paper"}) {
    const auto score = [&](Aid aid) {
      return scoreTracing({motion, 0, aid, arguments.lambda}, arguments.seeds, arguments.seconds);
    };
    const TracingScore unaided = score(Aid::none);
    const TracingScore hard = score(Aid::hard);
    const TracingScore soft = score(Aid::soft);
    fmt::print(
        "| {} | {:.0f} ± {:.0f} / {:.0f} / {:.0f} | {:.3f}, {:.3f} | {:.1f} ± {:.1f} / {:.0f} | {:.3f} | {:.1f} % |\n",
        motion, unaided.rms_um, unaided.rms_spread_um, unaided.median_um, unaided.p95_um, hard.rms_um,
        hard.in_force_max_um, soft.rms_um, soft.rms_spread_um, soft.p95_um, soft.law_max_um, 100.0 * hard.left_behind);
  }
}

std::function<void()> setUp(CLI::App& app, Arguments& arguments)
{
  addStandardOptions(app, kExamples);
  app.add_option("--seeds", arguments.seeds, "hands and eyes, from seed 0 on")->check(CLI::Range(1, 100000));
  app.add_option("--seconds", arguments.seconds, "of each, after 4 s to settle")->check(CLI::Range(1.0, 3600.0));
  app.add_option("--lambda", arguments.lambda, "of the soft fixture")->check(CLI::Range(0.0, 1.0));
  return [&arguments] { print(arguments); };
}

}  // namespace

int main(int argc, char** argv)
{
  Arguments arguments;
  return runProgram("simulate_tracing", "Traces the loop study's vessel with a simulated hand; prints a table.", argc,
                    argv, [&arguments](CLI::App& app) { return setUp(app, arguments); });
}
