// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/messaging/link.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/simulation/eye_camera.h"
#include "eyeslam/simulation/random.h"
#include "eyeslam/tracking/eyeslam_tracker.h"
#include "eyeslam/vision/lock_step_tracker.h"

namespace eyeslam::trials {

struct LockStepVisionOptions {
  double latency_low_ms = 14.0;
  double latency_high_ms = 20.0;
  tracking::TrackerOptions tracker;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("latency_low_ms", self.latency_low_ms, Range{0, 500}, "ms",
                  "shortest time from mid-exposure to the pose; source: loop study, 1");
    visitor.field("latency_high_ms", self.latency_high_ms, Range{0, 500}, "ms", "longest; source: loop study, 1");
    visitor.group("tracker", self.tracker);
  }
};

/// What stands between retina and camera.
enum class Obstruction {
  none,
  dark,    ///< no light
  covered  ///< an instrument close to the objective: grey, out of focus
};

/// A frame that was rendered and tracked, beside the truth; map px.
struct TrackedView {
  double t_s = 0.0;  ///< mid-exposure, since the start
  bool tracked = false;
  retina::Reason reason = retina::Reason::none;
  retina::Pose2 seen;   ///< map_T_frame by the tracker
  retina::Pose2 truth;  ///< and as it was
};

/// The real tracker on rendered frames, in lock step: a frame is tracked at once, and its messages go out when a camera
/// and a computer of the given latency would have sent them. No measured time enters a message.
class LockStepVision {
 public:
  LockStepVision(const LockStepVisionOptions& options, const simulation::EyeCameraOptions& camera,
                 const simulation::Fundus& fundus, messaging::Link& link, std::uint64_t seed);

  /// Renders and tracks a frame whose exposure is over.
  const TrackedView& look(const simulation::FrameDue& due);
  /// Sends what is ready by now.
  void step(const messaging::ReceiveTime& now);

  /// From the next frame on.
  void setObstruction(Obstruction obstruction) { obstruction_ = obstruction; }

  /// The newest frame.
  const TrackedView& newest() const { return newest_; }
  const tracking::EyeSlamTracker& tracker() const { return tracker_.tracker(); }
  const simulation::EyeCamera& camera() const { return camera_; }
  /// The newest picture.
  const cv::Mat& image() const { return image_; }

 private:
  double latency_low_, latency_high_;  // us
  simulation::EyeCamera camera_;
  vision::LockStepTracker tracker_;
  simulation::Random random_;
  TrackedView newest_;
  Obstruction obstruction_ = Obstruction::none;
  cv::Mat image_;
};

}  // namespace eyeslam::trials
