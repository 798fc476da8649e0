// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace eyeslam::retina {

/// The shortest turn that takes one direction to another; about any axis across them where they are opposite. None may
/// be zero. `Quaternion::FromTwoVectors` is the same and finds that axis by a decomposition, which compiles for 15 s.
inline Eigen::Quaterniond turnBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
  constexpr double kOpposite = 1e-12;  // of the cosine, from -1
  const Eigen::Vector3d first = from.normalized(), second = to.normalized();
  const double cosine = second.dot(first);
  Eigen::Quaterniond turn;
  if (cosine < kOpposite - 1.0) {
    turn.w() = 0.0;
    turn.vec() = first.unitOrthogonal();
    return turn;
  }
  const double half = std::sqrt((1.0 + cosine) * 2.0);  // twice the cosine of half the angle
  turn.vec() = first.cross(second) * (1.0 / half);
  turn.w() = half * 0.5;
  return turn;
}

}  // namespace eyeslam::retina
