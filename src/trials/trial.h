// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "eyeslam/files/log_event.h"
#include "eyeslam/mark_t.hpp"
#include "eyeslam/messaging/event_tap.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/simulation/hardware.h"
#include "eyeslam/simulation/truth_publisher.h"
#include "eyeslam/trials/lock_step_servo.h"
#include "eyeslam/trials/lock_step_vision.h"
#include "eyeslam/trials/manual_laser.h"
#include "eyeslam/trials/trial_operator.h"
#include "eyeslam/trials/trial_scene.h"
#include "eyeslam/trials/trial_surgeon.h"

namespace eyeslam::trials {

/// Which trial it is, as its log says it (the note of MARK START).
struct TrialName {
  std::string scenario, variant;
  std::uint64_t seed = 0;

  std::string json() const;
  /// @return none where the note is no such
  static std::optional<TrialName> parse(const std::string& note);
};

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
  double time() const { return hardware_.truth().t_s; }
  /// Null without an aid.
  const LockStepServo* servo() const { return servo_ ? &*servo_ : nullptr; }
  /// What the camera saw in this very step; null without a frame.
  const cv::Mat* frame() const { return frame_; }

 private:
  bool needsVision() const { return !setting_.scenario.isManual(); }
  void aim();
  void look();
  void decide(const messaging::ReceiveTime& now);
  void breakThings();
  void setFault(bool broken);
  bool isOver() const;
  void mark(std::int16_t kind, const std::string& note, std::int64_t utime);

  const TrialSetting& setting_;
  const TrialScene& scene_;
  TrialName name_;
  std::string version_;
  messaging::Link link_;
  messaging::EventTap tap_;
  messaging::Publisher<mark_t> marks_;
  TrialSurgeon surgeon_;
  simulation::Hardware hardware_;
  simulation::TruthPublisher truths_;
  std::optional<LockStepVision> vision_;
  std::optional<LockStepServo> servo_;
  std::optional<TrialOperator> operator_;
  std::optional<ManualLaser> manual_;
  std::int64_t steps_ = 0;
  std::optional<double> counts_s_, done_s_;
  bool broken_ = false;
  const cv::Mat* frame_ = nullptr;
};

}  // namespace eyeslam::trials
