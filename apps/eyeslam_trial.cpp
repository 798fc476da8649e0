// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-trial: scenarios in; logs, scores and a report out (contracts, sections 2 and 7).
#include "command_line/program.h"
#include "trial/trial_arguments.h"
#include "trial/trial_run.h"

int main(int argc, char** argv)
{
  using namespace eyeslam::apps;
  TrialArguments arguments;
  return runProgram("eyeslam-trial", "Runs trials of the whole system in lock step, and reports on them.", argc, argv,
                    [&arguments](CLI::App& app) {
                      addOptions(app, arguments);
                      return [&arguments] {
                        if (!arguments.dump.empty()) return dumpConfiguration(arguments);
                        runTrials(arguments);
                      };
                    });
}
