// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-servo: the live 1 kHz loop between vision and manipulator, over LCM (contracts, sections 2 and 4).
#include "command_line/program.h"
#include "servo/servo_arguments.h"
#include "servo/servo_run.h"

int main(int argc, char** argv)
{
  using namespace eyeslam::apps;
  ServoArguments arguments;
  return runProgram("eyeslam-servo", "Moves the tip of the manipulator by what vision sees, a thousand times a second.",
                    argc, argv, [&arguments](CLI::App& app) {
                      addOptions(app, arguments);
                      return [&arguments] {
                        if (!arguments.dump.empty()) return dump(arguments);
                        ServoRun(arguments).run();
                      };
                    });
}
