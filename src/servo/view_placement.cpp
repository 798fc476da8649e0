// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/view_placement.h"

#include <Eigen/LU>
#include <cmath>

namespace eyeslam::servo {

std::optional<ViewPlacement> placeView(const Registration& registration, const RetinaPlane& plane,
                                       const ViewScale& scale) noexcept
{
  const double m_per_px = 1e-6 * scale.um_per_px;
  if (!(m_per_px > 0.0) || !std::isfinite(m_per_px) || !scale.centre_px.allFinite()) return std::nullopt;
  // Image (px) and height (m) of a point are three linear equations; their solution for the unit steps are the axes.
  Eigen::Matrix3d linear;
  linear << registration.image_T_base.leftCols<3>() * m_per_px, plane.normal.transpose();
  constexpr double kGrazing = 1e-3;  // the sine of the angle between plane and line of sight, times the anisotropy
  const double determinant = linear.determinant();
  if (!linear.allFinite() || !(std::abs(determinant) > kGrazing)) return std::nullopt;
  const Eigen::Matrix3d inverse = linear.inverse();
  ViewPlacement placement;
  placement.manipulator_T_view.linear() << inverse.leftCols<2>(), -inverse.col(2);  // z goes into the retina
  const Eigen::Vector3d of_origin(-registration.image_T_base(0, 3) * m_per_px,
                                  -registration.image_T_base(1, 3) * m_per_px, plane.distance);
  placement.manipulator_T_view.translation() = inverse * of_origin;
  placement.centre = m_per_px * scale.centre_px;
  if (!placement.manipulator_T_view.matrix().allFinite()) return std::nullopt;
  return placement;
}

}  // namespace eyeslam::servo
