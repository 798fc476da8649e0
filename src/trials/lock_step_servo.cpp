// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/lock_step_servo.h"

#include "eyeslam/servo/registration_desk.h"
#include "eyeslam/simulation/hardware.h"

namespace eyeslam::trials {

namespace {

constexpr std::int64_t kPreparationPeriods = 100;  // as often as a background thread would look

// The retina at rest, for a calibration in which the aiming beam was not seen: as a second view would give it.
servo::RetinaPlane planeAtRest(const simulation::PlacementOptions& placement)
{
  const Eigen::Isometry3d manipulator_T_world = simulation::manipulatorTWorld(placement);
  const Eigen::Vector3d normal = manipulator_T_world.linear() * -Eigen::Vector3d::UnitZ();
  return {normal, normal.dot(manipulator_T_world.translation()), 0.0};
}

}  // namespace

LockStepServo::LockStepServo(const servo::ServoConfiguration& configuration,
                             const std::optional<servo::RetinaPlane>& plane, messaging::Link& link)
    : configuration_(configuration),
      plane_(plane),
      desk_(configuration.preparation, link),
      servo_(configuration.servo, link),
      plans_(link)
{}

LockStepServo::LockStepServo(const TrialSetting& setting, messaging::Link& link)
    : LockStepServo({setting.servo, setting.preparation, setting.calibration}, planeAtRest(setting.hardware.placement),
                    link)
{}

bool LockStepServo::resume(const messaging::PublishedRegistration& known, std::int64_t utime)
{
  const servo::CalibrationResult result = servo::calibrationOf(known, configuration_.servo.registration.camera);
  if (result.good()) servo_.adopt(result, utime);
  return result.good();
}

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
  servo::CalibrationResult found = servo::evaluate(*samples, configuration_.calibration);
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
