// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/live_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "command_line/picture_size.h"
#include "command_line/program.h"
#include "eyeslam/configuration/listing.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/simulation/retina_motion_options.h"
#include "real_time/scheduling.h"

namespace eyeslam::apps {
namespace {

constexpr unsigned kTurn_us = 20'000;

LiveWorld::Setting settingOf(const SimArguments& arguments)
try {
  LiveWorld::Setting setting;
  simulation::EyeCameraOptions& camera = setting.hardware.camera;
  camera.condition = arguments.condition;
  camera.fps = arguments.fps;
  if (!arguments.size.empty()) {
    const PictureSize size = pictureSize("--size", arguments.size);
    camera.width = size.width;
    camera.height = size.height;
  }
  setting.hardware.motion = simulation::retinaMotionOptions(arguments.motion.empty() ? "in_situ" : arguments.motion);
  for (const std::string& fault : arguments.faults) setting.faults.push_back(timedFault(fault));
  setting.duration_s = arguments.duration_s;
  if (setting.duration_s > 0.0) camera.duration_s = std::max(1.0, setting.duration_s);
  setting.foot_switch = arguments.foot_switch;
  setting.seed = arguments.seed;
  setting.task = liveTask(arguments.task, camera, simulation::umPerPx(camera, arguments.seed));
  return setting;
} catch (const std::invalid_argument& error) {
  throw UsageError(error.what());
}

simulation::EyeCamera cameraOf(const SimArguments& arguments, const simulation::EyeCameraOptions& options)
try {
  return simulation::EyeCamera(options, fundusOf(arguments, simulation::umPerPx(options, arguments.seed)),
                               arguments.seed);
} catch (const std::invalid_argument& error) {
  throw files::FileError(fmt::format("--retina {}: {}", arguments.retina, error.what()));
}

RunConfiguration recorded(const simulation::HardwareOptions& options)
{
  return {configuration::yamlOf(options), configuration::hashOf(options)};
}

std::string textOf(const TipErrors& errors)
{
  const TipErrors::Figures figures = errors.figures();
  return fmt::format("{:.0f} um RMS, {:.0f} median, {:.0f} p95 ({:.1f} s)", 1e6 * figures.rms, 1e6 * figures.median,
                     1e6 * figures.p95, 1e-3 * static_cast<double>(errors.samples()));
}

void say(const std::string& line)
{
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

}  // namespace

LiveRun::LiveRun(const SimArguments& arguments)
    : arguments_(arguments),
      setting_(settingOf(arguments)),
      um_per_px_(simulation::umPerPx(setting_.hardware.camera, arguments.seed)),
      feed_(cameraOf(arguments, setting_.hardware.camera), arguments.shm, arguments.fps),
      link_(openLink(arguments.link, newSession())),
      patient_link_(openLink(arguments.link, link_.session())),
      mark_(patient_link_, "eyeslam-sim", recorded(setting_.hardware)),
      poses_(patient_link_),
      states_(patient_link_)
{
  const std::string notice = unsignedNotice(arguments.link);
  if (!arguments.quiet && !notice.empty()) fmt::print(stderr, "eyeslam-sim: {}\n", notice);
}

void LiveRun::run()
{
  const bool real_time = [this] {
    const RealTimeSection section(kLoopPriority - 1);  // for LCM's receiver, which the first subscription starts
    world_.emplace(setting_, link_, feed_);
    return section.refusal().empty();
  }();
  const PictureSize size{setting_.hardware.camera.width, setting_.hardware.camera.height};
  say(fmt::format("live: task {}, {} x {} px at {} Hz, {:.2f} um/px, frames in shm:{}{}", arguments_.task, size.width,
                  size.height, arguments_.fps, um_per_px_, arguments_.shm, real_time ? "" : "; not in real time"));
  RealTimeLoop loop({1000, kLoopPriority}, [this](const CycleStart& start) { return world_->cycle(start); });
  while (!loop.ended() && !interruption_.requested() && !feed_.failed()) watch();
  loop.askToEnd();
  loop.join();
  feed_.end();
  sayScores();
}

void LiveRun::watch()
{
  usleep(kTurn_us);
  patient_link_.drain(receiveTime);
  if (arguments_.quiet) return;
  sayController();
  sayWhereTheTaskIs();
}

// Where the servo itself is gone, the reason stands here.
void LiveRun::sayController()
{
  const messaging::MicronState* state = states_.latest();
  if (state == nullptr) return;
  std::string said = state->follows_command ? "follows the servo" : "moves the tip by its own filter";
  if (!state->follows_command && state->reason != retina::Reason::none) {
    said += fmt::format(": {}", retina::word(state->reason));
  }
  if (said == last_controller_) return;
  say("controller: " + said);
  last_controller_ = std::move(said);
}

// A surgeon would point at the place in the picture. Here the place is known in the truth's map; one frame of which
// both poses are known takes it to vision's.
void LiveRun::sayWhereTheTaskIs()
{
  const messaging::RetinaPose* pose = poses_.latest();
  if (pose == nullptr || !pose->motion.tracked || pose->map.id == place_of_map_) return;
  const std::optional<retina::Pose2> truth = feed_.truth(pose->frame.utime);
  if (!truth) return;
  const cv::Point2d centre = simulation::imageCentre(setting_.hardware.camera);
  const Eigen::Vector2d centre_px(centre.x, centre.y);
  const Eigen::Vector2d place_px = setting_.task.place.head<2>() / (1e-6 * um_per_px_) - centre_px;
  const Eigen::Vector2d map_px = centre_px + pose->motion.map_T_frame * (truth->inverse() * place_px);
  place_of_map_ = pose->map.id;
  say(fmt::format("place: {:.1f} {:.1f} px of vision's map is where the task {}", map_px.x(), map_px.y(),
                  arguments_.task == "hold" ? "holds" : "begins"));
}

void LiveRun::sayScores() const
{
  const LiveWorld::Scores& scores = world_->scores();
  say(fmt::format("frames: {}", feed_.frames()));
  if (scores.alone.samples() > 0) say("tip error by hand alone: " + textOf(scores.alone));
  if (scores.guided.samples() > 0) say("tip error guided: " + textOf(scores.guided));
  if (!world_->hardware().pulses().empty()) say(fmt::format("pulses: {}", world_->hardware().pulses().size()));
}

}  // namespace eyeslam::apps
