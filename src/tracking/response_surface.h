// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "eyeslam/tracking/max_pooled_tables.h"
#include "eyeslam/tracking/turned_points.h"

namespace eyeslam::tracking {

/// Poses k in [k0, k1], j in [j0, j1], i in [i0, i1] of a grid.
struct PoseBox {
  int k0 = 0, k1 = 0, j0 = 0, j1 = 0, i0 = 0, i1 = 0;

  static PoseBox whole(const PoseGrid& grid)
  {
    return {-grid.half_k, grid.half_k, -grid.half_j, grid.half_j, -grid.half_i, grid.half_i};
  }
  /// The poses within so many steps and cells of one, and inside the grid.
  static PoseBox around(const GridPose& pose, const PoseGrid& grid, int steps, int cells);
};

/// The scores of all poses of a small box, every one computed.
class ResponseSurface {
 public:
  void reserve(int poses, int points);
  /// @param origin  cell of the map at which the tables begin; they hold every cell that a point touches from the box
  void evaluate(const TurnedPoints& points, const MaxPooledTables& tables, const cv::Point& origin, const PoseBox& box);

  GridPose best() const;
  /// Covariance of (x, y, theta) in px and rad about the mean of the poses weighted by exp((score - best) /
  /// temperature), plus that of one cell and step, so that a peak of one pose does not look perfect. Source: Olson 2009
  /// (facts A3.1).
  Eigen::Matrix3d covariance(const PoseGrid& grid, int points, double temperature) const;
  /// Calls visit(GridPose) for every pose that sums to at least `least`.
  template <class Visit>
  void forEachFrom(std::uint32_t least, Visit&& visit) const
  {
    const std::uint32_t* sum = sums_.data();
    for (int k = box_.k0; k <= box_.k1; ++k) {
      for (int j = box_.j0; j <= box_.j1; ++j, sum += width_) {
        for (int i = box_.i0; i <= box_.i1; ++i) {
          if (sum[i - box_.i0] >= least) visit(GridPose{k, j, i, sum[i - box_.i0]});
        }
      }
    }
  }

 private:
  std::uint32_t largestSum() const;

  PoseBox box_;
  int width_ = 0;  // of a row in memory: whole kernels
  std::vector<std::uint32_t> sums_;
  std::vector<std::uint32_t> columns_;
  std::vector<std::int32_t> offsets_;
};

}  // namespace eyeslam::tracking
