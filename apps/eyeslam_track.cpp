// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-track: a video in, trajectory, vessel map, mosaic and overlay out (contracts, sections 2 and 3).
#include <fmt/format.h>

#include "command_line/program.h"
#include "eyeslam/configuration/listing.h"
#include "track/track_arguments.h"
#include "track/track_run.h"

namespace {

using namespace eyeslam::apps;

void dump(const TrackArguments& arguments)
{
  const auto options = configurationOf(arguments);
  fmt::print("{}", arguments.dump == "markdown" ? eyeslam::configuration::markdownOf(options)
                                                : eyeslam::configuration::yamlOf(options));
}

}  // namespace

int main(int argc, char** argv)
{
  CLI::App app("Maps the vessels of a retina video and says in each frame where the view is.", "eyeslam-track");
  TrackArguments arguments;
  addOptions(app, arguments);
  return runProgram(app, argc, argv, [&arguments] {
    if (!arguments.dump.empty()) return dump(arguments);
    check(arguments);
    TrackRun(arguments).run();
  });
}
