// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace eyeslam::trials {

/// From a point to the nearest place of a straight line between two, which may be one; all in one unit.
inline double distanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from, const Eigen::Vector2d& to)
{
  constexpr double kNoLength = 1e-24;  // squared; a metre's unit, too, has shorter segments than that by no means
  const Eigen::Vector2d way = to - from;
  const double along = std::clamp((point - from).dot(way) / std::max(way.squaredNorm(), kNoLength), 0.0, 1.0);
  return (from + along * way - point).norm();
}

}  // namespace eyeslam::trials
