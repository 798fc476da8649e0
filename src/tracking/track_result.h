// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::tracking {

/// What one frame gave. All lengths in full-resolution px, angles in rad (contracts, section 1).
struct TrackResult {
  std::int64_t frame = -1;  ///< number of the frame, from 0
  bool tracked = false;
  retina::Reason reason = retina::Reason::none;          ///< why not tracked
  retina::Pose2 map_T_frame;                             ///< L_t; the last good one when not tracked
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, theta): px^2, px rad, rad^2
  /// Filtered, of (x, y, theta) per frame period; px, rad. Zero while not tracked, and of methods without a filter.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  int points = 0;      ///< vessel points used for matching
  double score = 0.0;  ///< mean cell value of the match, [0, 1]
};

/// Instrument tip in the image, full-resolution px.
struct ToolTip {
  bool present = false;
  double x_px = 0.0;
  double y_px = 0.0;
  double shaft_angle = 0.0;  ///< where the tip points, rad, image axes
  double shaft_width_px = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of the tip, px^2
};

/// The aiming beam's spot on the retina, full-resolution px of the image.
struct AimingSpot {
  bool present = false;
  double x_px = 0.0;
  double y_px = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< px^2
};

}  // namespace eyeslam::tracking
