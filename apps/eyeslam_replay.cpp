// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-replay: a logged experiment again: computed and compared, reported, as tables, as a part, on a live address
// (contracts, sections 2 and 7).
#include "command_line/program.h"
#include "replay/cut_run.h"
#include "replay/info_run.h"
#include "replay/log_pass.h"
#include "replay/overlay_run.h"
#include "replay/playback_run.h"
#include "replay/recompute_run.h"
#include "replay/replay_arguments.h"
#include "replay/report_run.h"
#include "replay/table_run.h"

int main(int argc, char** argv)
{
  using namespace eyeslam::apps;
  ReplayArguments arguments;
  return runProgram("eyeslam-replay", "Computes logged experiments again; reads, plays and cuts their logs.", argc,
                    argv, [&arguments](CLI::App& app) {
                      const ReplayCommands commands = addOptions(app, arguments);
                      return [&arguments, commands] {
                        requireOthers(arguments);
                        if (commands.info->parsed()) return showLog(arguments);
                        if (commands.cut->parsed()) return cutLog(arguments);
                        if (commands.report->parsed()) return reportLog(arguments);
                        if (commands.overlay->parsed()) return drawLog(arguments);
                        check(arguments);
                        if (!arguments.csv.empty()) return writeTables(arguments);
                        if (arguments.plays) return playLog(arguments);
                        recomputeLog(arguments);
                      };
                    });
}
