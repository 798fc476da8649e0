// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace eyeslam::simulation {

/// Where a surgeon who follows a path should be at an instant, and how fast; metres, m/s.
struct PathTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
};

/// A path that is traced at constant speed from its first point to its last and back, without end.
/// In the frame and the unit of its points; for a hand: the retina frame, m.
class TracedPath {
 public:
  /// @param points  at least two, in order, not all in one place
  /// @throws std::invalid_argument
  TracedPath(std::vector<Eigen::Vector3d> points, double speed);

  /// The first point is the target at t = 0.
  PathTarget at(double t_s) const;
  double length() const { return arc_.back(); }
  const std::vector<Eigen::Vector3d>& points() const { return points_; }

 private:
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> arc_;  // arc length at each point
  double speed_;
};

/// The vessel of the loop study, section 1: y = 300 sin(2 pi x / 3 mm + a) + 50 sin(2 pi x / 1.2 mm + b) um, 3 mm long
/// in x, from (0, y(0), 0), a point each `step` m of x; metres.
std::vector<Eigen::Vector3d> sineVessel(double a, double b, double step = 5e-6);

}  // namespace eyeslam::simulation
