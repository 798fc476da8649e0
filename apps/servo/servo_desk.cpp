// SPDX-License-Identifier: GPL-3.0-or-later
#include "servo/servo_desk.h"

#include <fmt/format.h>

#include <utility>

#include "eyeslam/retina/reason.h"
#include "eyeslam/servo/registration_desk.h"

namespace eyeslam::apps {

ServoDesk::ServoDesk(const servo::ServoConfiguration& options, messaging::Link& link, ServoExchanges& exchanges,
                     Answers answers)
    : options_(options),
      exchanges_(exchanges),
      answers_(std::move(answers)),
      preparation_(options.preparation, link),
      plans_(link)
{}

bool ServoDesk::resume(const messaging::PublishedRegistration& published)
{
  auto result =
      std::make_shared<servo::CalibrationResult>(servo::calibrationOf(published, options_.servo.registration.camera));
  if (!result->good()) return false;
  exchanges_.calibrations.offer(std::move(result));
  return true;
}

void ServoDesk::work(const messaging::ReceiveTime& now)
{
  if (preparation_.work(now)) exchanges_.preparations.offer(preparation_.newest());
  if (exchanges_.samples.take(samples_) && samples_) evaluate(now.utime);
  if (exchanges_.plans.take(plan_) && plan_) publishPlan(now.utime);
}

void ServoDesk::evaluate(std::int64_t utime)
{
  auto result = std::make_shared<servo::CalibrationResult>(servo::evaluate(*samples_, options_.calibration));
  tell(*result, utime);
  // A camera without a retina's plane is known better than before, though nothing is guided by it.
  if (result->reason == retina::Reason::none) exchanges_.calibrations.offer(std::move(result));
}

void ServoDesk::tell(const servo::CalibrationResult& result, std::int64_t utime)
{
  if (!result.good()) {
    const retina::Reason why = result.reason != retina::Reason::none ? result.reason : result.plane_reason;
    answers_.say(fmt::format("calibration failed: {} ({} frames)", retina::word(why), samples_->size()));
    return;
  }
  answers_.say(fmt::format("calibrated: {} tips, {:.2f} px; retina from {} spots, {:.0f} um",
                           result.camera.result().samples, result.camera.result().residual_px, result.surface_points,
                           1e6 * result.plane->residual));
  servo::RegistrationDesk desk(options_.servo.registration);
  desk.adopt(result, utime);
  answers_.keep(desk.published());
}

void ServoDesk::publishPlan(std::int64_t utime)
{
  plan_->utime = utime;
  plans_.publish(*plan_, utime);
}

}  // namespace eyeslam::apps
