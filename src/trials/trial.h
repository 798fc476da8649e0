// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "eyeslam/files/log_event.h"
#include "eyeslam/messaging/event_tap.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/trials/lock_step_servo.h"
#include "eyeslam/trials/lock_step_vision.h"
#include "eyeslam/trials/trial_scene.h"
#include "eyeslam/trials/trial_world.h"

namespace eyeslam::trials {

/// One trial in lock step with everything that a live one has: surgeon, eye, Micron, laser, rendered frames, the real
/// tracker, the servo, a human at the console, and nothing but messages between them on one link. Everything is decided
/// by setting, variant and seed: two runs send the same bytes.
///
///   Trial trial(setting, {"vessel_tracing", "aid=hard", 3}, version, scene, writeToLog);
///   while (trial.step()) progress.show(trial.time());
class Trial {
 public:
  using Each = std::function<void(const files::LogEvent&)>;

  /// @param setting, scene  must outlive it
  /// @param each            hears every message in the order of sending; what it throws comes out of `step`
  Trial(const TrialSetting& setting, const TrialName& name, const std::string& version, const TrialScene& scene,
        Each each);

  /// One millisecond. @return whether it goes on
  bool step();
  /// Since the start, s.
  double time() const { return world_.time(); }
  /// Null without an aid.
  const LockStepServo* servo() const { return servo_ ? &*servo_ : nullptr; }
  /// What the camera saw in this very step; null without a frame.
  const cv::Mat* frame() const { return frame_; }

 private:
  void look(const simulation::FrameDue& due);

  messaging::Link link_;
  messaging::EventTap tap_;
  TrialWorld world_;
  std::optional<LockStepVision> vision_;
  std::optional<LockStepServo> servo_;
  std::int64_t steps_ = 0;
  const cv::Mat* frame_ = nullptr;
};

}  // namespace eyeslam::trials
