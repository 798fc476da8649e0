// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-track: a video in, trajectory, vessel map, mosaic and overlay out (contracts, sections 2 and 3).
#include <fmt/format.h>

#include "command_line/program.h"
#include "eyeslam/configuration/listing.h"
#include "track/track_arguments.h"
#include "track/track_run.h"

namespace {

using namespace eyeslam::apps;

constexpr const char* kDocumentHead =
    "# Options of eyeslam-track\n\nFor `--set KEY=VALUE` and for `--config FILE.yaml`, in which groups nest. This page "
    "is what\n"
    "`eyeslam-track --dump-config=markdown` prints; `eyeslam-track --dump-config` prints a YAML file to start "
    "from.\n\n";

void dump(const TrackArguments& arguments)
{
  const TrackConfiguration options = configurationOf(arguments);
  if (arguments.dump == "yaml")
    fmt::print("{}", eyeslam::configuration::yamlOf(options));
  else if (arguments.dump == "markdown")
    fmt::print("{}{}", kDocumentHead, eyeslam::configuration::markdownOf(options));
  else
    throw UsageError(fmt::format("--dump-config={}: yaml or markdown is wanted", arguments.dump));
}

}  // namespace

int main(int argc, char** argv)
{
  TrackArguments arguments;
  return runProgram("eyeslam-track", "Maps the vessels of a retina video and says in each frame where the view is.",
                    argc, argv, [&arguments](CLI::App& app) {
                      addOptions(app, arguments);
                      return [&arguments] {
                        if (!arguments.dump.empty()) return dump(arguments);
                        check(arguments);
                        TrackRun(arguments).run();
                      };
                    });
}
