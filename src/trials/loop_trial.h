// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "eyeslam/servo/servo_cycle.h"
#include "eyeslam/simulation/camera_options.h"
#include "eyeslam/simulation/hand.h"
#include "eyeslam/simulation/micron_model.h"
#include "eyeslam/simulation/retina_motion.h"
#include "eyeslam/simulation/traced_path.h"
#include "eyeslam/simulation/tracker_model.h"
#include "eyeslam/trials/tip_judge.h"

namespace eyeslam::trials {

/// A lock-step trial of the loop on assumed tracker noise instead of pictures. The defaults are the loop study's "hold,
/// in situ, 30/20".
struct LoopTrialSetting {
  simulation::RetinaMotionOptions motion;
  simulation::HandOptions hand;
  simulation::MicronOptions micron;
  simulation::CameraTimingOptions camera;
  simulation::TrackerModelOptions tracker;
  simulation::RegistrationErrorOptions registration;
  servo::ServoCycleOptions servo;
  bool true_poses = false;  ///< the true pose of each millisecond instead of the tracker's
  bool port_measured = true;
  bool aided = true;         ///< false: the bare hand, the tip where the null is
  double settling_s = 4.0;   ///< before anything counts
  double duration_s = 20.0;  ///< that counts
};

/// What the surgeon wants and how the tip's error is judged; retina frame, m.
struct LoopTask {
  /// Where he wants the tip at an instant, and how fast that moves along its path.
  std::function<simulation::PathTarget(double t_s)> target;
  /// The goal of the tip, by the null; a fixture.
  std::function<Eigen::Vector3d(const servo::Outlook& outlook)> fixture;
  /// How far from right a tip is, m.
  std::function<double(const Eigen::Vector3d& tip_retina, double t_s)> error;
};

/// Hold one place of the retina.
LoopTask holdTask(const Eigen::Vector3d& place);

struct LoopResult : TipErrors {
  double highest_goal_speed = 0.0;  ///< m/s
  servo::Refusals refusals;
};

/// Where the trial takes place: 1 mm off the image's centre, which the registration error turns about.
Eigen::Vector3d workingPlace();

/// Runs one seed. Deterministic. @throws std::invalid_argument for an unknown motion
LoopResult runLoopTrial(const LoopTrialSetting& setting, const LoopTask& task, std::uint64_t seed);

}  // namespace eyeslam::trials
