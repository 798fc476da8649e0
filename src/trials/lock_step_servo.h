// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/servo/calibration.h"
#include "eyeslam/servo/plan_schedule.h"
#include "eyeslam/servo/preparation.h"
#include "eyeslam/servo/servo.h"
#include "eyeslam/servo/servo_configuration.h"
#include "eyeslam/trials/scenario.h"

namespace eyeslam::trials {

/// All of `eyeslam-servo` in lock step: the loop, and what the program prepares beside it, at fixed cycles. Given the
/// same messages in the same milliseconds it sends the same ones, to the byte: in a trial and in the replay of its log.
class LockStepServo {
 public:
  /// @param plane  of the retina as a second view would give it, for a calibration whose aiming beam was not seen
  /// @param link   must outlive it
  LockStepServo(const servo::ServoConfiguration& configuration, const std::optional<servo::RetinaPlane>& plane,
                messaging::Link& link);
  /// As a trial has it.
  LockStepServo(const TrialSetting& setting, messaging::Link& link);

  /// One millisecond, after the link was drained with the same time.
  void cycle(const messaging::ReceiveTime& now);

  /// Begins with a registration that is known already. @param utime  us since 1970, when it was estimated
  /// @return whether it is good enough
  bool resume(const messaging::PublishedRegistration& known, std::int64_t utime);

  /// The retina's plane comes from the aiming beam.
  bool sweptPlane() const { return swept_plane_; }

 private:
  void prepare(const messaging::ReceiveTime& now);
  void publishPlan(std::int64_t utime);

  servo::ServoConfiguration configuration_;
  std::optional<servo::RetinaPlane> plane_;
  servo::PreparationDesk desk_;
  servo::Servo servo_;
  messaging::Publisher<burn_plan_t> plans_;
  burn_plan_t plan_{};
  servo::PlanSchedule schedule_;
  std::int64_t cycles_ = 0;
  bool swept_plane_ = false;
};

}  // namespace eyeslam::trials
