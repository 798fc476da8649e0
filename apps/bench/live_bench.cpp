// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/live_bench.h"

#include <cmath>

#include "eyeslam/simulation/eye_camera.h"
#include "eyeslam/simulation/procedural_fundus.h"
#include "link/program_link.h"
#include "real_time/scheduling.h"

namespace eyeslam::apps {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr std::int64_t kWishPeriod = 50;  // steps

Eigen::Vector3d middle(const simulation::HardwareOptions& options)
{
  const cv::Point2d centre = simulation::imageCentre(options.camera);
  const double m_per_px = 1e-6 * simulation::umPerPx(options.camera, kSeed);
  return {m_per_px * centre.x, m_per_px * centre.y, -0.3e-3};
}

std::vector<cv::Mat> rendered(const simulation::HardwareOptions& options, int count)
{
  simulation::ProceduralFundusOptions fundus;
  fundus.um_per_px = simulation::umPerPx(options.camera, kSeed);
  simulation::EyeCamera camera(options.camera, simulation::proceduralFundus(fundus, kSeed), kSeed);
  messaging::Link link("memq://", 1, {});
  simulation::Hardware hardware(options, simulation::holdPlace(middle(options)), link, kSeed);
  std::vector<cv::Mat> frames;
  for (std::int64_t utime = 1'700'000'000'000'000; static_cast<int>(frames.size()) < count; utime += 1000) {
    hardware.step({utime, utime});
    if (const auto due = hardware.frameDue()) frames.push_back(camera.render(*due).image.clone());
  }
  return frames;
}

// LCM's receiver takes over the class of who subscribes first.
messaging::Link realTimeLink(const std::string& url) { return openLink({url, ""}, newSession()); }

}  // namespace

BenchManipulator::BenchManipulator(const std::string& url, const simulation::HardwareOptions& options,
                                   std::size_t expected)
    : link_(realTimeLink(url)),
      statuses_(link_),
      commands_(link_,
                [this](const messaging::MicronCommand& command, const messaging::MessageHeader& header) {
                  if (records_) arrivals_.push_back({header.utime_sent, command.utime_image});
                }),
      wishes_(link_),
      hardware_(options, simulation::holdPlace(middle(options)), link_, kSeed),
      thread_({1000, kLoopPriority}, [this](const CycleStart& start) { return step(start); })
{
  arrivals_.reserve(expected);
}

void BenchManipulator::end()
{
  thread_.askToEnd();
  thread_.join();
}

bool BenchManipulator::step(const CycleStart& start)
{
  link_.drain(receiveTime);
  for (; left_out_ < start.left_out; ++left_out_) hardware_.step({start.monotonic, start.utime});
  hardware_.step({start.monotonic, start.utime});
  hardware_.frameDue();
  ready_ = statuses_.latest() != nullptr && statuses_.latest()->state == messaging::ServoState::ready &&
           statuses_.latest()->frame_to_command >= 0.0;
  if (++steps_ % kWishPeriod == 0) {
    messaging::OperatorWish wish;
    wish.mode = messaging::WantedMode::ready;
    wishes_.publish(wish, start.utime, start.utime);
  }
  return true;
}

BareLoop::BareLoop(std::size_t expected)
    : thread_({1000, kLoopPriority}, [this](const CycleStart& start) {
        if (records_) starts_.push_back({start.utime, static_cast<float>(1e6 * start.lateness)});
        return true;
      })
{
  starts_.reserve(expected);
}

void BareLoop::end()
{
  thread_.askToEnd();
  thread_.join();
}

FramePlayer::FramePlayer(const std::string& name, const simulation::HardwareOptions& options, int frames)
    : exposure_(simulation::exposureTime(options.camera)),
      frames_(rendered(options, frames)),
      ring_(name, {frames_.front().size(), frames_.front().type(), options.camera.fps}),
      thread_({std::llround(1e6 / options.camera.fps), 0}, [this](const CycleStart& start) { return step(start); })
{}

bool FramePlayer::step(const CycleStart& start)
{
  const auto count = static_cast<std::int64_t>(frames_.size());
  const std::int64_t phase = number_ % (2 * count - 2);
  const std::int64_t index = phase < count ? phase : 2 * count - 2 - phase;
  const auto exposure_us = std::llround(1e6 * exposure_);
  ring_.write(frames_[static_cast<std::size_t>(index)], {number_++, start.utime - exposure_us / 2, exposure_us});
  return true;
}

}  // namespace eyeslam::apps
