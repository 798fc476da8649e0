// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/rendered_trial.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/servo/servo.h"
#include "eyeslam/simulation/hardware.h"
#include "eyeslam/simulation/procedural_fundus.h"
#include "eyeslam/trials/lock_step_time.h"
#include "eyeslam/trials/loop_trial.h"

namespace eyeslam::trials {

namespace {

constexpr std::int64_t kPeriod_us = 1000;
constexpr std::int64_t kOperatorPeriods = 50;      // 20 Hz (contracts, section 4)
constexpr std::int64_t kPreparationPeriods = 100;  // as often as a background thread would look
constexpr double kMicro = 1e-6;
constexpr double kReady_s = 1.0;        // then a map is there
constexpr double kCalibrated_s = 30.0;  // at the latest, or there is nothing to be judged
constexpr double kNever_s = 1e9;

Eigen::Vector2d centrePx(const simulation::EyeCameraOptions& camera)
{
  const cv::Point2d centre = simulation::imageCentre(camera);
  return {centre.x, centre.y};
}

// The retina at rest, for a calibration in which the aiming beam was not seen: as a second view would give it.
servo::RetinaPlane planeAtRest(const simulation::Hardware& hardware)
{
  const Eigen::Vector3d normal = hardware.manipulatorTWorld().linear() * -Eigen::Vector3d::UnitZ();
  return {normal, normal.dot(hardware.manipulatorTWorld().translation()), 0.0};
}

simulation::Fundus fundusOf(std::uint64_t seed)
{
  simulation::ProceduralFundusOptions options;
  return simulation::proceduralFundus(options, seed);
}

class RenderedTrial {
 public:
  RenderedTrial(const RenderedTrialSetting& setting, std::uint64_t seed)
      : setting_(setting),
        link_("memq://", static_cast<std::int64_t>(seed) + 1, std::nullopt),
        um_per_px_(simulation::umPerPx(setting.hardware.camera, seed)),
        place_(middleOfView() + workingPlace()),
        hardware_(
            setting.hardware, [this](double t_s) { return task(t_s); }, link_, seed),
        vision_(setting.vision, setting.hardware.camera, fundusOf(seed), link_, seed),
        desk_(setting.preparation, link_),
        servo_(setting.servo, link_),
        operators_(link_),
        judge_(0.0)
  {
    if (!setting.aided) begin_s_ = setting.settling_s;
  }

  RenderedResult run()
  {
    const double latest_s = kCalibrated_s + setting_.settling_s + setting_.duration_s;
    for (std::int64_t i = 0; t() <= std::min(begin_s_ + setting_.duration_s, latest_s); ++i) step(i);
    static_cast<TipErrors&>(result_) = judge_.result();
    return std::move(result_);
  }

 private:
  Eigen::Vector3d middleOfView() const
  {
    const Eigen::Vector2d centre = kMicro * um_per_px_ * centrePx(setting_.hardware.camera);
    return {centre.x(), centre.y(), 0.0};
  }

  double t() const { return hardware_.truth().t_s; }
  bool isEngaged() const { return begin_s_ < kNever_s; }

  // While the tip sweeps he looks at the handle, not at the tip.
  simulation::SurgeonTask task(double) const
  {
    using Support = simulation::HandTremor::Support;
    simulation::SurgeonTask task;
    task.target.position = place_;
    task.steers_null = !setting_.aided || !isEngaged();
    task.support = setting_.aided && isEngaged() ? Support::fixture : Support::none;
    return task;
  }

  void step(std::int64_t i)
  {
    const std::int64_t utime = kStart_us + i * kPeriod_us;
    const messaging::ReceiveTime now{utime, utime};
    hardware_.step(now);
    if (setting_.aided) {
      if (const auto due = hardware_.frameDue()) look(*due);
      vision_.step(now);
      if (i % kOperatorPeriods == 0) operators_.publish(wish(), utime, utime);
      link_.drain(now);
      if (i % kPreparationPeriods == 0) prepare(now);
      servo_.cycle(now, {});
      link_.drain(now);
      watch();
    }
    judge();
  }

  // What a program does beside its loop.
  void prepare(const messaging::ReceiveTime& now)
  {
    if (desk_.work(now)) servo_.adopt(desk_.newest());
    const servo::CalibrationSamples* samples = servo_.samples();
    if (!samples) return;
    servo::CalibrationResult found = servo::evaluate(*samples, setting_.calibration);
    servo_.samplesTaken();
    result_.plane_swept = found.plane.has_value();
    if (!found.plane) found.plane = planeAtRest(hardware_);
    servo_.adopt(found, now.utime);
  }

  void look(const simulation::FrameDue& due)
  {
    const TrackedView& view = vision_.look(due);
    ++result_.frames;
    if (!view.tracked) return judge_.spoilt(view.t_s);
    ++result_.tracked;
    const Eigen::Vector2d centre = centrePx(setting_.hardware.camera);
    const Eigen::Vector2d frame_px = view.truth.inverse() * (place_.head<2>() / (kMicro * um_per_px_) - centre);
    const Eigen::Vector2d seen_px = centre + view.seen * frame_px;
    if (!isEngaged()) point_px_ = seen_px;
    result_.pose_errors_m.push_back(kMicro * um_per_px_ * (seen_px - point_px_).norm());
  }

  // First a calibration, then the place; what the human points at is where he sees it, in the map of that frame.
  messaging::OperatorWish wish()
  {
    messaging::OperatorWish wish;
    wish.mode = t() < kReady_s ? messaging::WantedMode::ready : messaging::WantedMode::assist;
    wish.map_id = link_.session();
    if (!isEngaged() && servo_.registration().good()) begin_s_ = t() + setting_.settling_s;
    if (isEngaged()) {
      wish.fixture.kind = messaging::FixtureKind::point;
      wish.fixture.point_px = point_px_;
    } else {
      wish.fixture.kind = messaging::FixtureKind::calibration;
    }
    return wish;
  }

  void watch()
  {
    const messaging::ServoStatus& status = servo_.status();
    if (t() < kReady_s || status.state == last_state_) return;
    last_state_ = status.state;
    if (status.state == messaging::ServoState::assist) return;
    result_.obstacles.push_back(
        {t(), std::string(messaging::word(status.state)), std::string(retina::word(status.reason))});
  }

  void judge()
  {
    const simulation::HardwareTruth& truth = hardware_.truth();
    const double moved = last_tip_ ? (truth.tip - *last_tip_).norm() : 0.0;
    last_tip_ = truth.tip;
    const Eigen::Vector3d tip = setting_.aided ? truth.tipRetina() : truth.nullRetina();
    result_.highest_tip_speed = std::max(result_.highest_tip_speed, 1e3 * moved);
    if (truth.t_s < begin_s_) return;
    judge_.step({truth.t_s, tip, (tip - place_).head<2>().norm(), truth.jerk, truth.jerked, truth.saturated});
    result_.worst_pivot_error = std::max(result_.worst_pivot_error, truth.pivot_error);
  }

  const RenderedTrialSetting& setting_;
  messaging::Link link_;
  double um_per_px_;
  Eigen::Vector3d place_;  // retina frame, m
  simulation::Hardware hardware_;
  LockStepVision vision_;
  servo::PreparationDesk desk_;
  servo::Servo servo_;
  messaging::Publisher<operator_t> operators_;
  TipJudge judge_;
  double begin_s_ = kNever_s;  // of what counts; known when the fixture is asked for
  Eigen::Vector2d point_px_ = Eigen::Vector2d::Zero();
  std::optional<Eigen::Vector3d> last_tip_;
  messaging::ServoState last_state_ = messaging::ServoState::assist;
  RenderedResult result_;
};

}  // namespace

RenderedTrialSetting renderedSetting(const std::string& motion, const std::string& camera, const std::string& condition)
{
  RenderedTrialSetting setting;
  setting.hardware.motion = simulation::retinaMotionOptions(motion);
  simulation::EyeCameraOptions& eye = setting.hardware.camera;
  eye.condition = condition;
  eye.duration_s = 60.0;
  if (camera == "120/5") {
    eye.fps = 120.0;
    eye.exposure_ms = 4.0;
    eye.width = 400;
    eye.height = 304;
    setting.vision.latency_low_ms = 3.5;
    setting.vision.latency_high_ms = 5.0;
    setting.vision.tracker.frame.scale = 1.0;
  } else if (camera != "30/20") {
    throw std::invalid_argument("camera '" + camera + "' is not known; 30/20 and 120/5 are");
  }
  setting.servo.image_width_px = eye.width;
  setting.servo.image_height_px = eye.height;
  return setting;
}

RenderedResult holdOnRenderedFrames(const RenderedTrialSetting& setting, std::uint64_t seed)
{
  return RenderedTrial(setting, seed).run();
}

}  // namespace eyeslam::trials
