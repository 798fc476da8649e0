// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-view: what the human wants, as OPERATOR, and what the servo does (contracts, sections 2 and 4).
#include "command_line/program.h"
#include "view/console_run.h"
#include "view/view_arguments.h"

int main(int argc, char** argv)
{
  using namespace eyeslam::apps;
  ViewArguments arguments;
  return runProgram("eyeslam-view", "Tells the servo what the human wants, and the human what the servo does.", argc,
                    argv, [&arguments](CLI::App& app) {
                      addOptions(app, arguments);
                      return [&arguments] {
                        if (!arguments.console) {
                          throw UsageError("the window is not built yet; eyeslam-view --console takes lines instead");
                        }
                        ConsoleRun(arguments).run();
                      };
                    });
}
