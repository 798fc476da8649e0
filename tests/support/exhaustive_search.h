// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <tuple>

#include "eyeslam/tracking/match_result.h"
#include "eyeslam/tracking/occupancy_map.h"
#include "eyeslam/tracking/vessel_point.h"

namespace eyeslam::support {

/// The answer that scan matching promises, by trying every pose of the window, cell by cell, in plain words: centre
/// plus whole cells and whole angular steps, mean cell value, ties to the pose nearest the centre, then to the lowest
/// angle, row and column. Returns pose and score alone.
inline tracking::MatchResult searchExhaustively(const tracking::ScanPoints& points, const tracking::OccupancyMap& map,
                                                const tracking::SearchWindow& window)
{
  const double cell_px = map.cellSize();
  double radius_px = 0.0;
  for (const auto& point : points) radius_px = std::max(radius_px, point.cast<double>().norm());
  const double farthest_cells = std::max(10.0, radius_px * window.centre.scale / cell_px);
  const double step = 2.0 * std::asin(0.5 / farthest_cells);
  const auto halfOf = [](double half, double unit) { return static_cast<int>(std::ceil(half / unit - 1e-9)); };
  const int half_i = halfOf(window.half_x_px, cell_px), half_j = halfOf(window.half_y_px, cell_px);
  const int half_k = halfOf(window.half_theta, step);

  tracking::MatchResult best;
  std::int64_t best_sum = -1;
  std::tuple<int, int, int, int> best_order;
  for (int k = -half_k; k <= half_k; ++k) {
    for (int j = -half_j; j <= half_j; ++j) {
      for (int i = -half_i; i <= half_i; ++i) {
        const retina::Pose2 pose{window.centre.x + i * cell_px, window.centre.y + j * cell_px,
                                 window.centre.theta + k * step, window.centre.scale};
        const Eigen::Matrix2d linear = pose.linear();
        std::int64_t sum = 0;
        for (const auto& point : points) {
          const Eigen::Vector2d at = (linear * point.cast<double>() + pose.translation()) / cell_px;
          sum += map.cell(static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())));
        }
        const std::tuple<int, int, int, int> order(k * k + j * j + i * i, k, j, i);
        if (sum > best_sum || (sum == best_sum && order < best_order)) {
          best_sum = sum;
          best_order = order;
          best.map_T_frame = pose;
        }
      }
    }
  }
  best.score = points.empty() ? 0.0 : static_cast<double>(best_sum) / (255.0 * static_cast<double>(points.size()));
  return best;
}

}  // namespace eyeslam::support
