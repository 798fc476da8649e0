// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/sim_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <opencv2/imgcodecs.hpp>

#include "command_line/number_check.h"
#include "command_line/program.h"
#include "eyeslam/files/picture_file.h"
#include "eyeslam/simulation/fundus_photograph.h"
#include "eyeslam/simulation/hardware_fault.h"
#include "eyeslam/simulation/procedural_fundus.h"
#include "eyeslam/simulation/retina_motion_options.h"

namespace eyeslam::apps {
namespace {

constexpr const char* kProcedural = "procedural";
constexpr const char* kExamples =
    "  eyeslam-sim --out human --condition human\n"
    "  eyeslam-sim --out jumps --condition saccade --frames 600 --seed 7 --size 640x480\n"
    "  eyeslam-sim --out mine --retina fundus.jpg --vessels mask.png --retina-um-per-px 4 --condition laser\n"
    "  eyeslam-sim --live --task hold --size 400x304\n"
    "  eyeslam-sim --live --duration 60 --fault states_stop@20 --fault camera_freezes@40\n"
    "--out writes video.mp4, truth.csv, tool.csv, vessels.png and meta.json; the same call gives the same pictures.\n"
    "--live is surgeon, eye, Micron and laser behind the messages of real ones, and a camera in shared memory:\n"
    "eyeslam-track shm:eye --lcm '' sees it, eyeslam-servo moves it, eyeslam-view --console tells it what to do.";

void addCommonOptions(CLI::App& app, SimArguments& a)
{
  app.add_option("--condition", a.condition,
                 "how it looks: human, paper, porcine, laser, saccade, blackout, plain, deform, excursion, hd")
      ->capture_default_str();
  app.add_option("--motion", a.motion,
                 fmt::format("how the eye moves: smooth, jerky, saccade, in_situ, excursion, scaling (default: the "
                             "condition's); live: {} (default in_situ)",
                             fmt::join(simulation::retinaMotionNames(), ", ")));
  app.add_option("--retina", a.retina, "'procedural', or a photograph of a fundus")->capture_default_str();
  app.add_option("--vessels", a.vessels, "mask of the photograph's vessels, for the truth");
  app.add_option("--retina-um-per-px", a.retina_um_per_px, "width of the photograph's pixel, um")
      ->check(CLI::Range(0.1, 100.0))
      ->capture_default_str();
  app.add_option("--size", a.size, "WIDTHxHEIGHT of the video, px (default: the condition's, 800x608)");
  app.add_option("--seed", a.seed, "everything that is left to chance")->capture_default_str();
  app.add_flag("--quiet", a.quiet, "no progress, no advice");
}

void addSequenceOptions(CLI::App& app, SimArguments& a)
{
  app.add_option("--out", a.out, "folder of the sequence")->group("Sequence");
  app.add_option("--frames", a.frames, "length of the video")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->group("Sequence");
  app.add_flag("--lossless", a.lossless, "write video.mkv, every bit kept, instead of video.mp4")->group("Sequence");
}

void addLiveOptions(CLI::App& app, SimArguments& a)
{
  app.add_flag("--live", a.live, "run in real time behind the messages")->group("Live");
  app.add_option("--lcm", a.link.url, "LCM URL; default LCM_DEFAULT_URL, else this computer only")
      ->type_name("URL")
      ->group("Live");
  app.add_option("--key", a.link.key, "key that signs the messages: 64 hexadecimal digits")
      ->type_name("FILE")
      ->group("Live");
  app.add_option("--shm", a.shm, "name of the camera's frames: eyeslam-track shm:NAME")
      ->type_name("NAME")
      ->capture_default_str()
      ->group("Live");
  app.add_option("--fps", a.fps, "frames a second")->check(within(1.0, 1000.0))->capture_default_str()->group("Live");
  app.add_option("--duration", a.duration_s, "s; 0: until Ctrl-C")
      ->check(within(0.0, 86400.0))
      ->capture_default_str()
      ->group("Live");
  app.add_option("--task", a.task, "what the surgeon does: hold a place, trace a path, laser a pattern")
      ->check(CLI::IsMember({"hold", "trace", "laser"}))
      ->capture_default_str()
      ->group("Live");
  app.add_option(
         "--fault", a.faults,
         fmt::format("what goes wrong when, may be repeated: {}", fmt::join(simulation::hardwareFaultNames(), ", ")))
      ->type_name("WHAT@SECONDS")
      ->expected(1)
      ->take_all()
      ->group("Live");
  app.add_flag("--foot-switch", a.foot_switch, "the laser's foot switch is pressed")->group("Live");
}

}  // namespace

void addOptions(CLI::App& app, SimArguments& arguments)
{
  addCommonOptions(app, arguments);
  addSequenceOptions(app, arguments);
  addLiveOptions(app, arguments);
  addStandardOptions(app, kExamples);
}

void check(const SimArguments& arguments)
{
  if (arguments.live && !arguments.out.empty()) throw UsageError("--out: writes a sequence, --live none; take one");
  if (!arguments.live && arguments.out.empty()) throw UsageError("--out DIR is missing, or --live");
  if (!arguments.live && !(arguments.link.url.empty() && arguments.link.key.empty() && arguments.faults.empty())) {
    throw UsageError("--lcm, --key and --fault need --live");
  }
  if (arguments.retina == kProcedural && !arguments.vessels.empty()) {
    throw UsageError("--vessels: the procedural retina knows its vessels; name a photograph with --retina");
  }
}

simulation::Fundus fundusOf(const SimArguments& arguments, double um_per_px)
{
  if (arguments.retina == kProcedural) {
    simulation::ProceduralFundusOptions options;
    options.um_per_px = um_per_px;
    return simulation::proceduralFundus(options, arguments.seed);
  }
  const cv::Mat photograph = files::readPicture("--retina", arguments.retina, cv::IMREAD_COLOR);
  const cv::Mat mask =
      arguments.vessels.empty() ? cv::Mat() : files::readPicture("--vessels", arguments.vessels, cv::IMREAD_GRAYSCALE);
  simulation::FundusPhotographOptions options;
  options.um_per_px = arguments.retina_um_per_px;
  return simulation::fundusFromPhotograph(photograph, mask, options);
}

}  // namespace eyeslam::apps
