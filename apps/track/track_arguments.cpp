// SPDX-License-Identifier: GPL-3.0-or-later
#include "track/track_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "command_line/number_check.h"
#include "command_line/program.h"
#include "eyeslam/baselines/method.h"
#include "eyeslam/configuration/assignment.h"

namespace eyeslam::apps {
namespace {

const char* const kExamples =
    "  eyeslam-track surgery.mp4 --out results\n"
    "  eyeslam-track frames/ --out results --fps 25 --um-per-px 5.2\n"
    "  eyeslam-track 'frames/im*.png' --out results --set frame.scale=0.4 --snapshots 60,150\n"
    "  eyeslam-track camera:0 --out results --display --record camera.mkv\n"
    "  eyeslam-track shm:eye --out results --no-overlay --lcm '' --key micron.key\n"
    "  eyeslam-track --dump-config > my.yaml && eyeslam-track surgery.mp4 --out results --config my.yaml\n";

void addInputs(CLI::App& app, TrackArguments& a)
{
  app.add_option("INPUT", a.input, "Video file, image folder, glob of images, camera:N, or shm:NAME");
  app.add_option("--out", a.out, "Folder for the results")->type_name("DIR");
  app.add_option("--from", a.from, "First frame, from 0")->type_name("FRAME")->check(frameNumber());
  app.add_option("--to", a.to, "Last frame")->type_name("FRAME")->check(frameNumber());
  app.add_option("--fps", a.fps, "Frames per second of images")->type_name("F")->check(within(0.001, 100000.0));
  app.add_option("--timeout", a.timeout, "How long shm:NAME and each of its frames is waited for")
      ->type_name("S")
      ->check(within(0.01, 1e6));
  app.add_option("--um-per-px", a.um_per_px,
                 "Size of a pixel of the first frame; default: that of meta.json beside INPUT")
      ->type_name("UM")
      ->check(within(1e-6, 1e6));
  app.add_option("--truth", a.truth, "Folder of a sequence with truth: adds pictures of error and coverage")
      ->type_name("DIR");
}

void addTracking(CLI::App& app, TrackArguments& a)
{
  app.add_option("--method", a.method, fmt::format("One of {}", fmt::join(baselines::methodNames(), ", ")))
      ->type_name("NAME");
  app.add_option("--config", a.config, "YAML file with options; --dump-config prints all")->type_name("FILE");
  app.add_option("--set", a.settings, "One option; may be repeated")
      ->type_name("GROUP.KEY=VALUE")
      ->expected(1)
      ->take_all();
  app.add_option("--scale", a.scale, "Processed per full px (frame.scale), default 0.5")->type_name("S");
  app.add_option("--seed", a.seed, "Seed of every random choice (selector.seed)")->type_name("N");
  app.add_flag("--dump-config{yaml}", a.dump, "Print all options as YAML and exit; =markdown: as tables");
}

void addOutputs(CLI::App& app, TrackArguments& a)
{
  app.add_option("--snapshots", a.snapshots, "Also keep the map as it is after these frames")
      ->type_name("F,F,...")
      ->delimiter(',')
      ->check(frameNumber());
  app.add_option("--record", a.record, "Write each processed frame into a lossless video")->type_name("FILE.mkv");
  app.add_option("--lcm", a.lcm, "Publish poses, map and tip over LCM; '' = LCM_DEFAULT_URL")->type_name("URL");
  app.add_option("--key", a.key, "Key that signs the messages: 64 hexadecimal digits")->type_name("FILE");
  app.add_flag("--no-overlay", a.no_overlay, "Write no overlay.mp4");
  app.add_flag("--display", a.display, "Show frames and vessels in a window");
  app.add_flag("--quiet", a.quiet, "Print nothing but errors");
}

}  // namespace

void addOptions(CLI::App& app, TrackArguments& arguments)
{
  addInputs(app, arguments);
  addTracking(app, arguments);
  addOutputs(app, arguments);
  addStandardOptions(app, kExamples);
}

void check(const TrackArguments& arguments)
{
  const auto methods = baselines::methodNames();
  if (arguments.input.empty())
    throw UsageError("INPUT is missing; a video file, image folder, glob, camera:N or shm:NAME is wanted");
  if (arguments.out.empty()) throw UsageError("--out DIR is missing; name a folder for the results");
  if (std::find(methods.begin(), methods.end(), arguments.method) == methods.end()) {
    throw UsageError(fmt::format("--method {}: there is none; one of {}", arguments.method, fmt::join(methods, ", ")));
  }
  std::error_code none;  // they need not be there
  if (std::filesystem::equivalent(arguments.input, arguments.out, none)) {
    throw UsageError(
        fmt::format("--out {}: is INPUT; results there would pass for frames, name another", arguments.out));
  }
  if (arguments.to >= 0 && arguments.to < arguments.from) {
    throw UsageError(fmt::format("--to {} is before --from {}", arguments.to, arguments.from));
  }
  if (!arguments.key.empty() && !arguments.lcm) throw UsageError("--key FILE needs --lcm URL");
  if (!arguments.truth.empty() && arguments.from > 0) {
    throw UsageError(fmt::format("--from {}: --truth needs frame 0, in which the truth's map lies", arguments.from));
  }
  if (!arguments.record.empty() && std::filesystem::path(arguments.record).extension() != ".mkv") {
    throw UsageError(fmt::format("--record {}: a name that ends in .mkv is wanted", arguments.record));
  }
}

TrackConfiguration configurationOf(const TrackArguments& arguments)
{
  std::vector<configuration::Assignment> assignments;
  if (!arguments.config.empty()) assignments = configuration::readYaml(arguments.config);
  for (const std::string& setting : arguments.settings) assignments.push_back(configuration::parseSetting(setting));
  if (arguments.scale) assignments.push_back({"frame.scale", *arguments.scale, "--scale"});
  if (arguments.seed) assignments.push_back({"selector.seed", *arguments.seed, "--seed"});
  return configuration::applied(TrackConfiguration{}, assignments);
}

}  // namespace eyeslam::apps
