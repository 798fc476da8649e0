// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/lock_step_vision.h"

#include <cmath>

namespace eyeslam::trials {

namespace {

constexpr std::uint64_t kStream = 61;             // of the seed's random numbers
constexpr double kMetal[] = {96.0, 98.0, 100.0};  // BGR grey levels

// What the camera's own noise leaves of a picture without light, or behind metal near the lens.
void obstruct(Obstruction obstruction, cv::Mat& image)
{
  if (obstruction == Obstruction::none) return;
  constexpr double kNoise = 0.03;  // of the picture: that it is not the same twice
  image *= kNoise;
  if (obstruction == Obstruction::covered) image += cv::Scalar(kMetal[0], kMetal[1], kMetal[2]);
}

}  // namespace

LockStepVision::LockStepVision(const LockStepVisionOptions& options, const simulation::EyeCameraOptions& camera,
                               const simulation::Fundus& fundus, messaging::Link& link, std::uint64_t seed)
    : latency_low_(1e3 * options.latency_low_ms),
      latency_high_(1e3 * options.latency_high_ms),
      camera_(camera, fundus, seed),
      tracker_(options.tracker, link, 0.0, camera.fps),
      random_(seed, kStream)
{}

const TrackedView& LockStepVision::look(const simulation::FrameDue& due)
{
  const simulation::RenderedFrame frame = camera_.render(due);
  image_ = frame.image;
  obstruct(obstruction_, image_);
  const auto latency = std::llround(random_.uniform(latency_low_, latency_high_));
  const tracking::TrackResult& result =
      tracker_.look(image_, {due.utime, due.frame, due.exposure}, due.utime + latency).result;
  newest_ = {due.t_s, result.tracked, result.reason, result.map_T_frame, frame.map_T_frame};
  return newest_;
}

void LockStepVision::step(const messaging::ReceiveTime& now) { tracker_.send(now.utime); }

}  // namespace eyeslam::trials
