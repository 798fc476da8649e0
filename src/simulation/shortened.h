// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace eyeslam::simulation {

/// The way, but no longer than `longest`.
inline Eigen::Vector3d shortened(const Eigen::Vector3d& way, double longest)
{
  const double length = way.norm();
  return length > longest ? Eigen::Vector3d(way * (longest / length)) : way;
}

}  // namespace eyeslam::simulation
