// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/servo/calibration.h"
#include "eyeslam/servo/preparation.h"
#include "eyeslam/servo/servo_options.h"
#include "eyeslam/simulation/hardware_options.h"
#include "eyeslam/trials/lock_step_vision.h"
#include "eyeslam/trials/tip_judge.h"

namespace eyeslam::trials {

/// A lock-step trial with everything that a live one has: the real tracker on rendered frames, the whole servo, the
/// simulated hardware, and nothing but messages between them. The defaults are "hold, in situ, 30/20".
struct RenderedTrialSetting {
  simulation::HardwareOptions hardware;
  LockStepVisionOptions vision;
  servo::ServoOptions servo;
  servo::PreparationOptions preparation;
  servo::CalibrationOptions calibration;
  bool aided = true;         ///< false: the bare hand, the tip where the null is
  double settling_s = 4.0;   ///< after the fixture was asked for, before anything counts; source: loop study
  double duration_s = 20.0;  ///< that counts
};

/// @param motion     paper, in_situ, jerky, saccade
/// @param camera     30/20 at 800x608, or 120/5 at 400x304
/// @param condition  how it looks, as in EyeCameraOptions
/// @throws std::invalid_argument naming the word
RenderedTrialSetting renderedSetting(const std::string& motion, const std::string& camera,
                                     const std::string& condition);

/// A time in which the servo was not in the wanted state.
struct Obstacle {
  double t_s = 0.0;
  std::string state, reason;
};

struct RenderedResult : TipErrors {
  int frames = 0, tracked = 0;
  std::vector<double> pose_errors_m;  ///< of the tracker at the place held, a sample a tracked frame
  std::vector<Obstacle> obstacles;    ///< each change of the servo's state after it was engaged, but the wanted one
  double highest_tip_speed = 0.0;     ///< m/s
  bool plane_swept = false;           ///< the retina's plane comes from the aiming beam, not from the simulation
  double worst_pivot_error = 0.0;     ///< m, of the shaft from the commanded centre of motion
};

/// The tip sweeps, the camera is registered by what the tracker saw of it, and a hard point fixture holds one place of
/// the retina, 1 mm from the image's centre. One seed; deterministic.
RenderedResult holdOnRenderedFrames(const RenderedTrialSetting& setting, std::uint64_t seed);

}  // namespace eyeslam::trials
