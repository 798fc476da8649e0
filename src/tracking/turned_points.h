// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/vessel_point.h"

namespace eyeslam::tracking {

/// The poses a search tries: a centre plus whole angular steps k and whole cells i (right) and j (down).
struct PoseGrid {
  retina::Pose2 centre;  ///< frame px
  double cell_px = 1.0;
  double theta_step = 0.0;
  int half_i = 0;
  int half_j = 0;
  int half_k = 0;

  retina::Pose2 pose(int k, int j, int i) const
  {
    return {centre.x + i * cell_px, centre.y + j * cell_px, retina::wrapAngle(centre.theta + k * theta_step),
            centre.scale};
  }
  int columns() const { return 2 * half_i + 1; }
  int rows() const { return 2 * half_j + 1; }
};

/// One pose of a grid and the sum of the cells under its points.
struct GridPose {
  int k = 0;
  int j = 0;
  int i = 0;
  std::uint32_t sum = 0;

  int distance2() const { return k * k + j * j + i * i; }
};

/// Whether a is the better answer: the larger sum; of equal ones the pose nearest the centre; then a fixed order.
bool isBetter(const GridPose& a, const GridPose& b);

/// The points of one frame, turned to each angle of a grid once, as cells: shifts by whole cells then are additions.
class TurnedPoints {
 public:
  /// Points further from the image centre than this are left out; frame px.
  static constexpr double kReach_px = 8192.0;

  void reserve(int points, int angles);
  /// Takes the finite ones among the points; of more than `most_points` an even choice.
  void assign(const ScanPoints& points, int most_points);
  int size() const { return static_cast<int>(x_.size()); }
  /// Distance of the farthest point from the image centre, frame px.
  double radius() const { return radius_; }
  /// The angle that moves the farthest point by one cell; rad. Points all near the centre count as ten cells away.
  double stepFor(double cell_px, double scale) const;

  /// Turns the points to the angles k = first, first + 1, ... of the grid, seen from its centre's position.
  void turn(const PoseGrid& grid, int first_k, int angles);
  int firstAngle() const { return first_k_; }
  int angles() const { return angles_; }
  /// The rectangle of cells that the points touch at the centre, over all angles.
  const cv::Rect& extent() const { return extent_; }
  const std::int32_t* cellX(int k) const { return cell_x_.data() + index(k); }
  const std::int32_t* cellY(int k) const { return cell_y_.data() + index(k); }

 private:
  std::size_t index(int k) const { return static_cast<std::size_t>(k - first_k_) * x_.size(); }

  std::vector<double> x_, y_;
  double radius_ = 0.0;
  int first_k_ = 0;
  int angles_ = 0;
  cv::Rect extent_;
  std::vector<std::int32_t> cell_x_, cell_y_;
};

}  // namespace eyeslam::tracking
