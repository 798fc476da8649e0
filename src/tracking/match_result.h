// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::tracking {

/// Where the view should be; frame px, rad; covariance of (x, y, theta).
struct PosePrediction {
  retina::Pose2 map_T_frame;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// A pose and how sure it is; frame px, rad; covariance of (x, y, theta).
struct PoseEstimate {
  retina::Pose2 map_T_frame;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Poses to try: `centre` give or take the halves; its scale is kept. Frame px, rad.
struct SearchWindow {
  retina::Pose2 centre;
  double half_x_px = 0.0;
  double half_y_px = 0.0;
  double half_theta = 0.0;
};

/// What a search found. When it was refused, pose and score are those of the best place seen; in large windows, where
/// nothing below the least score is looked at, those of the centre.
struct MatchResult {
  retina::Reason reason = retina::Reason::none;  ///< too_few_points, ambiguous, poor_match, searching; none: found
  retina::Pose2 map_T_frame;                     ///< frame px, whole cells from the window's centre
  double score = 0.0;                            ///< mean cell value under the points, [0, 1]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, theta): px^2, px rad, rad^2
};

}  // namespace eyeslam::tracking
