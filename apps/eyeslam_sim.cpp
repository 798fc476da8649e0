// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-sim: microscope video with exact truth (contracts, section 5), or eye, hand, Micron and laser behind the
// messages of real ones (contracts, section 4).
#include "command_line/program.h"
#include "sim/live_run.h"
#include "sim/sequence_run.h"
#include "sim/sim_arguments.h"

int main(int argc, char** argv)
{
  using namespace eyeslam::apps;
  SimArguments arguments;
  return runProgram("eyeslam-sim", "Renders a retina through a surgical microscope with exact truth, or runs it live.",
                    argc, argv, [&arguments](CLI::App& app) {
                      addOptions(app, arguments);
                      return [&arguments] {
                        check(arguments);
                        if (!arguments.live) return renderSequence(arguments);
                        LiveRun(arguments).run();
                      };
                    });
}
