// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-replay: what a log holds, as tables, as a part of it, on a live address (contracts, sections 2 and 7).
#include "command_line/program.h"
#include "replay/cut_run.h"
#include "replay/info_run.h"
#include "replay/playback_run.h"
#include "replay/replay_arguments.h"
#include "replay/table_run.h"

int main(int argc, char** argv)
{
  using namespace eyeslam::apps;
  ReplayArguments arguments;
  return runProgram("eyeslam-replay", "Reads, plays and cuts logs of experiments.", argc, argv,
                    [&arguments](CLI::App& app) {
                      const ReplayCommands commands = addOptions(app, arguments);
                      return [&arguments, commands] {
                        if (commands.info->parsed()) return showLog(arguments);
                        if (commands.cut->parsed()) return cutLog(arguments);
                        check(arguments);
                        if (!arguments.csv.empty()) return writeTables(arguments);
                        playLog(arguments);
                      };
                    });
}
