// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "eyeslam/servo/camera_registration.h"

namespace eyeslam::servo {

/// How the view (see `ViewPose`) lies in the manipulator's frame; from the registration and the retina's plane.
struct ViewPlacement {
  Eigen::Affine3d manipulator_T_view = Eigen::Affine3d::Identity();
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< of the image, view frame, m
};

/// What the view's metres are: every party of the servo must use the same number.
struct ViewScale {
  double um_per_px = 0.0;                               ///< nominal: an error in it is taken up by the placement
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< of the image, full-resolution px
};

/// x and y along the retina as the image shows them, z along the line of sight, into the retina, one metre of it a
/// metre of height: image(manipulator_T_view * view) = view / m per px at any height, and points of the retina's plane
/// have z = 0. @return none where the camera looks along the plane, or the scale is unknown. Never allocates.
std::optional<ViewPlacement> placeView(const Registration& registration, const RetinaPlane& plane,
                                       const ViewScale& scale) noexcept;

}  // namespace eyeslam::servo
