// SPDX-License-Identifier: GPL-3.0-or-later
#include "trial/real_time_trial.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "command_line/clocks.h"
#include "command_line/version.h"
#include "eyeslam/configuration/listing.h"
#include "eyeslam/files/whole_file.h"
#include "eyeslam/mark_t.hpp"
#include "eyeslam/messaging/decoding.h"
#include "eyeslam/servo/servo_configuration.h"
#include "eyeslam/simulation/eye_camera.h"
#include "link/program_link.h"
#include "real_time/scheduling.h"
#include "track/track_configuration.h"

namespace eyeslam::apps {
namespace {

constexpr std::int64_t kPeriod_us = 1000;
constexpr double kPatience_s = 20.0;  // until the programs beside have started
constexpr int kTurn_ms = 5;
constexpr std::size_t kBatch = 16;         // messages that are logged under one time
constexpr useconds_t kCtrlC_us = 200'000;  // until it is known here
constexpr int kLastTurns = 40;             // after the end: what is still under way
constexpr const char* kTracker = "eyeslam-track";
constexpr const char* kServo = "eyeslam-servo";

// The program whose MARK START it is; empty for anything else.
std::string starterIn(const messaging::TappedEvent& event)
{
  mark_t mark{};
  const bool starts =
      event.channel == "MARK" && messaging::decode(event.data, event.size, mark) && mark.kind == mark_t::START;
  return starts ? mark.sender : "";
}

void checkFault(const std::string& kind)
{
  if (kind != "blackout" && kind != "tool_over_everything") return;
  throw std::invalid_argument(
      fmt::format("fault.kind {}: the camera in real time has none; leave --real-time out", kind));
}

template <class Options>
void writeOptions(const std::string& path, const Options& options)
{
  files::writeWholeFile(path, configuration::yamlOf(options, configuration::YamlComments::left_out));
}

}  // namespace

RealTimeTrial::RealTimeTrial(const trials::TrialSetting& setting, const trials::TrialName& name,
                             const trials::TrialScene& scene, std::string video, Each each)
    : setting_(setting),
      name_(name),
      scene_(scene),
      video_(std::move(video)),
      url_(privateUrl(7 * static_cast<int>(name.seed % 1000))),
      shm_(fmt::format("eyeslam_trial_{}_{}", getpid(), name.seed)),
      scratch_("eyeslam_trial"),
      logger_(openLink({url_, ""}, newSession())),
      tap_(logger_,
           [this, each = std::move(each)](const messaging::TappedEvent& event) {
             each({event.number, event.utime, event.channel, event.data, event.size});
             if (const std::string program = starterIn(event); !program.empty()) started_.insert(program);
           }),
      link_(openLink({url_, ""}, newSession()))
{
  checkFault(setting.scenario.fault.kind);
}

bool RealTimeTrial::run(const std::function<bool(double)>& goesOn)
{
  if (!setting_.scenario.isManual()) {
    startPrograms();
    waitForPrograms();
  }
  startWorld();
  bool whole = true;
  while (whole && !loop_->ended()) {
    hear(kTurn_ms);
    whole = goesOn(time_s_);
    if (!whole || programsRun()) continue;
    usleep(kCtrlC_us);  // which ends them, too
    whole = goesOn(time_s_);
    if (whole) checkPrograms();
  }
  loop_->askToEnd();
  loop_->join();
  if (feed_) feed_->end();
  if (!whole) return false;
  for (int i = 0; i < kLastTurns; ++i) hear(kTurn_ms);
  endPrograms();
  return true;
}

void RealTimeTrial::startPrograms()
{
  const std::string folder = programFolder();
  writeOptions(scratch_.path("track.yaml"), TrackConfiguration{setting_.vision.tracker, {}});
  writeOptions(scratch_.path("servo.yaml"),
               servo::ServoConfiguration{setting_.servo, setting_.preparation, setting_.calibration});
  feed_.emplace(simulation::EyeCamera(scene_.camera(), scene_.fundus(), name_.seed), shm_, setting_.scenario.camera_hz);
  servo_.emplace(folder + "/" + kServo,
                 std::vector<std::string>{"--lcm", url_, "--config", scratch_.path("servo.yaml"), "--quiet"});
  std::vector<std::string> words = {
      "shm:" + shm_,          "--lcm",        url_,     "--config", scratch_.path("track.yaml"), "--out",
      scratch_.path("track"), "--no-overlay", "--quiet"};
  if (!video_.empty()) words.insert(words.end(), {"--record", video_});
  tracker_.emplace(folder + "/" + kTracker, words);
}

void RealTimeTrial::waitForPrograms()
{
  const double begin = monotonicSeconds();
  while (started_.count(kTracker) + started_.count(kServo) < 2) {
    hear(kTurn_ms);
    checkPrograms();
    if (monotonicSeconds() - begin > kPatience_s)
      throw std::runtime_error(
          fmt::format("{} and {} were not heard of on {} within {:.0f} s; is multicast on the "
                      "loopback allowed?",
                      kTracker, kServo, url_, kPatience_s));
  }
}

void RealTimeTrial::startWorld()
{
  const RealTimeSection section(kLoopPriority - 1);  // for LCM's receiver, which the first subscription starts
  world_.emplace(setting_, name_, kVersion, scene_, link_);
  loop_.emplace(RealTimeLoopSetting{kPeriod_us, kLoopPriority},
                [this](const CycleStart& start) { return cycle(start); });
}

bool RealTimeTrial::cycle(const CycleStart& start)
{
  link_.drain(receiveTime);
  catch_up_.run(start, [this](std::int64_t monotonic, std::int64_t utime) {
    if (world_->isOver()) return;
    const messaging::ReceiveTime now{monotonic, utime};
    std::optional<simulation::FrameDue> due = world_->advance(now);
    if (feed_) feed_->show(std::move(due));
    world_->tellTruth(now);
    world_->act(now);
  });
  time_s_ = world_->time();
  return !world_->isOver();
}

void RealTimeTrial::hear(int timeout_ms)
{
  logger_.wait(timeout_ms);
  std::size_t heard = kBatch;
  while (heard == kBatch) {
    const messaging::ReceiveTime now = receiveTime();
    tap_.setTime(now.utime);
    heard = logger_.drain(now, kBatch);
  }
}

bool RealTimeTrial::programsRun()
{
  return (!tracker_ || tracker_->runs()) && (!servo_ || servo_->runs()) && !(feed_ && feed_->failed());
}

void RealTimeTrial::checkPrograms()
{
  for (std::optional<ChildProgram>* program : {&tracker_, &servo_}) {
    if (*program && !(*program)->runs())
      throw std::runtime_error(fmt::format("{} has ended during the trial; what it said stands above",
                                           program == &tracker_ ? kTracker : kServo));
  }
  if (feed_ && feed_->failed()) feed_->end();  // throws why
}

void RealTimeTrial::endPrograms()
{
  for (std::optional<ChildProgram>* program : {&servo_, &tracker_}) {
    if (*program) (*program)->interrupt();
    hear(kTurn_ms);
    program->reset();
  }
}

}  // namespace eyeslam::apps
