// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/loop_conditions.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace eyeslam::trials {

namespace {

constexpr double kSlack_s = 0.04;  // issue 16, after a saccade
constexpr double kSettledShare = 0.05;

LoopTrialSetting withoutDisturbance()
{
  LoopTrialSetting setting = loopSetting("paper", "30/20");
  setting.motion.speed_low_mm_s = setting.motion.speed_high_mm_s = 0.0;
  setting.motion.rotation_deg = 0.0;
  simulation::HandTremorOptions& hand = setting.hand.tremor;
  hand.tremor_low_um = hand.tremor_high_um = hand.drift_low_um = hand.drift_high_um = hand.lean_um = 0.0;
  setting.hand.surgeon.gain_hz = 0.0;
  setting.micron.noise_um = setting.micron.bend_um = setting.micron.gain_error = 0.0;
  setting.registration = {0.0, 0.0, 0.0, setting.registration.drift_s};
  simulation::TrackerModelOptions& tracker = setting.tracker;
  tracker.noise_um = tracker.bias_um = tracker.turn_noise_deg = tracker.outliers = tracker.tip_noise_um = 0.0;
  return setting;
}

}  // namespace

LoopTrialSetting loopSetting(const std::string& motion, const std::string& camera)
{
  LoopTrialSetting setting;
  setting.motion = simulation::retinaMotionOptions(motion);
  if (camera == "120/5") {
    setting.camera = {120.0, 4.0, 3.5, 5.0};
  } else if (camera == "true") {
    setting.true_poses = true;
  } else if (camera != "30/20") {
    throw std::invalid_argument("camera '" + camera + "' is not known; 30/20, 120/5 and true are");
  }
  return setting;
}

const std::vector<LeftOut>& leftOut()
{
  using Setting = LoopTrialSetting;
  static const std::vector<LeftOut> parts = {
      {"nothing", [](Setting&) {}, 16.5, 13.8},
      {"null prediction", [](Setting& s) { s.servo.predicts_null = false; }, 41.3, 40.1},
      {"trim", [](Setting& s) { s.servo.trims = false; }, 37.8, 36.7},
      {"integral action", [](Setting& s) { s.servo.integral.rate_per_s = 0.0; }, 20.4, 18.6},
      {"port feed-forward", [](Setting& s) { s.port_measured = false; }, 18.1, 14.0},
      {"jump gate", [](Setting& s) { s.servo.retina.gated = false; }, 0.0, 0.0},
      {"inverse of the plant", [](Setting& s) { s.servo.plant.response_hz = 0.0; }, 0.0, 0.0}};
  return parts;
}

RecoveryTiming recoveryTiming(const LoopTrialSetting& setting)
{
  return {1e-3 * setting.camera.latency_high_ms, 1.0 / setting.camera.rate_hz, 1e-3 * setting.servo.limits.speed_mm_s};
}

double recoveryDeadline(const RecoveryTiming& timing, const Jump& jump)
{
  return timing.latency_s + timing.frame_s + jump.way / timing.speed + kSlack_s;
}

void countRecoveries(const RecoveryTiming& timing, const std::vector<Jump>& jumps, RecoveryCount& count)
{
  for (const Jump& jump : jumps) {
    if (jump.disturbed) continue;
    const bool in_time = jump.recovery_s <= recoveryDeadline(timing, jump);
    ++count.jumps;
    if (in_time) ++count.in_time;
    if (jump.whole) ++count.whole;
    if (jump.whole && in_time) ++count.whole_in_time;
    count.seconds.push_back(jump.recovery_s);
  }
}

StepResponse stepResponse(double step, double speed_mm_s)
{
  LoopTrialSetting setting = withoutDisturbance();
  setting.servo.limits.speed_mm_s = speed_mm_s;
  setting.settling_s = 1.0;
  setting.duration_s = 1.0;
  const Eigen::Vector3d place = workingPlace();
  const Eigen::Vector3d there = place + step * Eigen::Vector3d(0.6, 0.8, 0.0);
  LoopTask task = holdTask(place);
  // The cycle in which the goal steps is the first that counts; its time is the world's, not the outlook's.
  std::int64_t cycles = 0;
  const auto first = static_cast<std::int64_t>(std::llround(setting.settling_s * 1e3));
  task.fixture = [&](const servo::Outlook&) { return ++cycles > first ? there : place; };
  task.error = [&](const Eigen::Vector3d& tip, double) { return (tip - there).norm(); };
  const LoopResult result = runLoopTrial(setting, task, 1);
  StepResponse response;
  for (std::size_t i = 0; i < result.path.size(); ++i) {
    const double along = (result.path[i] - place).dot(there - place) / (step * step);
    response.overshoot = std::max(response.overshoot, along - 1.0);
    if (result.errors_m[i] > kSettledShare * step) response.late_s = 1e-3 * static_cast<double>(i + 1);
  }
  response.late_s -= step / (1e-3 * speed_mm_s);
  return response;
}

}  // namespace eyeslam::trials
