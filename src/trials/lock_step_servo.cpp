// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/lock_step_servo.h"

namespace eyeslam::trials {

namespace {

constexpr std::int64_t kPreparationPeriods = 100;  // as often as a background thread would look
constexpr std::int64_t kPlanPeriods = 1000;        // contracts, section 4

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
  ++since_plan_;
  if (servo_.planReason() != retina::Reason::none) return;
  const std::int64_t changes = servo_.ledger().changes();
  if (changes == plan_changes_ && since_plan_ < kPlanPeriods) return;
  if (!servo_.ledger().describe(*desk_.newest(), plan_)) return;
  plan_.utime = utime;
  plans_.publish(plan_, utime);
  plan_changes_ = changes;
  since_plan_ = 0;
}

}  // namespace eyeslam::trials
