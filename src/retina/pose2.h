// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace eyeslam::retina {

/// Planar similarity about the image centre c: m = c + scale R(theta) (p - c) + (x, y), R = [[cos, -sin], [sin, cos]]
/// in image axes (x right, y down), source: contracts, section 1. As `map_T_frame` it takes a frame pixel p to the map
/// pixel m. The centre itself is not part of the value: every pose of a video shares it, and composition, inversion
/// and comparison do not need it, because points are given relative to it (`d = p - c`).
/// The unit of x and y is the pixel of the picture that the pose speaks of; theta is in rad.
struct Pose2 {
  double x = 0.0;
  double y = 0.0;
  double theta = 0.0;
  double scale = 1.0;

  /// The linear part, scale R(theta).
  Eigen::Matrix2d linear() const;
  Eigen::Vector2d translation() const { return {x, y}; }

  /// Maps a point given relative to the image centre; the result is relative to the centre as well.
  Eigen::Vector2d operator*(const Eigen::Vector2d& from_centre) const { return linear() * from_centre + translation(); }
  /// a_T_b * b_T_c = a_T_c.
  Pose2 operator*(const Pose2& other) const;
  Pose2 inverse() const;
};

/// The angle wrapped to (-pi, pi]; rad.
double wrapAngle(double theta);

}  // namespace eyeslam::retina
