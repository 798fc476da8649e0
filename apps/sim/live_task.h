// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "eyeslam/simulation/eye_camera_options.h"
#include "eyeslam/simulation/hardware.h"

namespace eyeslam::apps {

/// What the simulated surgeon is about, and how the tip is judged; retina frame, m.
struct LiveTask {
  simulation::SurgeonTaskAt surgeon;                ///< without support and switches, which change while it runs
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< where it begins
  /// How far from right a tip is, across the line of sight.
  std::function<double(const Eigen::Vector3d& tip)> error;
};

/// @param name  hold, trace or laser
LiveTask liveTask(const std::string& name, const simulation::EyeCameraOptions& camera, double um_per_px);

}  // namespace eyeslam::apps
