// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include "eyeslam/retina/pose2.h"

namespace eyeslam::simulation {

/// Where the retina is, world_T_retina: m and rad. Both frames: x right and y down as in the image, z into the retina.
/// They are one at the start of a motion; the world stays with microscope and manipulator, the retina frame with the
/// tissue: x, y = map px x um per px x 1e-6.
///   world = centre + R(theta) (retina - centre) + shift
struct RetinaPose {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< the place that it turns about, retina frame
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();   ///< of that place
  double theta = 0.0;                                ///< about z, from x to y

  Eigen::Matrix3d rotation() const { return Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ()).toRotationMatrix(); }
  Eigen::Isometry3d isometry() const
  {
    Eigen::Isometry3d world_T_retina = Eigen::Isometry3d::Identity();
    world_T_retina.linear() = rotation();
    world_T_retina.translation() = centre + shift - rotation() * centre;
    return world_T_retina;
  }
  Eigen::Vector3d toWorld(const Eigen::Vector3d& retina) const
  {
    return centre + rotation() * (retina - centre) + shift;
  }
  Eigen::Vector3d toRetina(const Eigen::Vector3d& world) const
  {
    return centre + rotation().transpose() * (world - centre - shift);
  }
};

/// The same as the pose of a view through a microscope that stands still, map_T_frame in px (contracts, section 1).
/// The axial motion is not in it: the camera is affine.
/// @param image_centre_px  of the frame, full-resolution px
inline retina::Pose2 viewPose(const RetinaPose& world_T_retina, const Eigen::Vector2d& image_centre_px,
                              double um_per_px)
{
  const double px = um_per_px * 1e-6;
  const Eigen::Vector3d centre(image_centre_px.x() * px, image_centre_px.y() * px, 0.0);
  const Eigen::Vector3d moved = (world_T_retina.toRetina(centre) - centre) / px;
  return {moved.x(), moved.y(), -world_T_retina.theta, 1.0};
}

}  // namespace eyeslam::simulation
