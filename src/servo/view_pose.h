// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "eyeslam/retina/pose2.h"

namespace eyeslam::servo {

/// Where the retina lies in the view, in metres. The view frame: x, y = px of the image x m per px (x right, y down),
/// z = 0 on the retina's surface, z into it; the retina frame: the same in the map frame. Height passes unchanged.
///   view = centre + scale R(theta) (retina - centre) + (x, y)
struct ViewPose {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< of the image, m
  retina::Pose2 view_T_retina;                       ///< m, rad, about that centre

  Eigen::Vector3d toView(const Eigen::Vector3d& retina) const
  {
    Eigen::Vector3d view = retina;
    view.head<2>() = centre + view_T_retina * (retina.head<2>() - centre);
    return view;
  }
  Eigen::Vector3d toRetina(const Eigen::Vector3d& view) const
  {
    Eigen::Vector3d retina = view;
    retina.head<2>() = centre + view_T_retina.inverse() * (view.head<2>() - centre);
    return retina;
  }
};

/// view_T_retina from a tracker's pose.
/// @param map_T_frame  px (contracts, section 1); @param m_per_px  of full-resolution map px
inline retina::Pose2 viewTRetina(const retina::Pose2& map_T_frame, double m_per_px)
{
  retina::Pose2 pose = map_T_frame.inverse();
  pose.x *= m_per_px;
  pose.y *= m_per_px;
  return pose;
}

}  // namespace eyeslam::servo
