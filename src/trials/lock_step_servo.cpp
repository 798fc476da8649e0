// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/lock_step_servo.h"

namespace eyeslam::trials {

namespace {

constexpr std::int64_t kPreparationPeriods = 100;  // as often as a background thread would look

}  // namespace

LockStepServo::LockStepServo(const Options& options, const std::optional<servo::RetinaPlane>& plane,
                             messaging::Link& link)
    : calibration_(options.calibration),
      plane_(plane),
      desk_(options.preparation, link),
      servo_(options.servo, link),
      plans_(link)
{}

void LockStepServo::cycle(const messaging::ReceiveTime& now)
{
  if (cycles_++ % kPreparationPeriods == 0) prepare(now);
  servo_.cycle(now, {});
  publishPlan(now.utime);
}

void LockStepServo::prepare(const messaging::ReceiveTime& now)
{
  if (desk_.work(now)) servo_.adopt(desk_.newest());
  const servo::CalibrationSamples* samples = servo_.samples();
  if (!samples) return;
  servo::CalibrationResult found = servo::evaluate(*samples, calibration_);
  servo_.samplesTaken();
  swept_plane_ = found.plane.has_value();
  if (!found.plane) found.plane = plane_;
  servo_.adopt(found, now.utime);
}

void LockStepServo::publishPlan(std::int64_t utime)
{
  if (!schedule_.isDue(servo_) || !servo_.ledger().describe(*desk_.newest(), plan_)) return;
  plan_.utime = utime;
  plans_.publish(plan_, utime);
  schedule_.told(servo_);
}

}  // namespace eyeslam::trials
