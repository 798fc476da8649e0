// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/turned_points.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "eyeslam/tracking/match_kernels.h"

namespace eyeslam::tracking {

bool isBetter(const GridPose& a, const GridPose& b)
{
  if (a.sum != b.sum) return a.sum > b.sum;
  return std::make_tuple(a.distance2(), a.k, a.j, a.i) < std::make_tuple(b.distance2(), b.k, b.j, b.i);
}

void TurnedPoints::reserve(int points, int angles)
{
  const auto count = static_cast<std::size_t>(points);
  x_.reserve(count);
  y_.reserve(count);
  cell_x_.reserve(count * static_cast<std::size_t>(angles));
  cell_y_.reserve(count * static_cast<std::size_t>(angles));
}

void TurnedPoints::assign(const ScanPoints& points, int most_points)
{
  x_.clear();
  y_.clear();
  double radius2 = 0.0;
  const std::size_t count = std::min(points.size(), static_cast<std::size_t>(std::max(0, most_points)));
  for (std::size_t n = 0; n < count; ++n) {
    const Eigen::Vector2d point = points[n * points.size() / count].cast<double>();
    if (!(point.norm() < kReach_px)) continue;  // NaN as well
    x_.push_back(point.x());
    y_.push_back(point.y());
    radius2 = std::max(radius2, point.squaredNorm());
  }
  radius_ = std::sqrt(radius2);
}

double TurnedPoints::stepFor(double cell_px, double scale) const
{
  constexpr double kLeastRadius_cells = 10.0;
  return 2.0 * std::asin(0.5 / std::max(kLeastRadius_cells, radius_ * std::abs(scale) / cell_px));
}

void TurnedPoints::turn(const PoseGrid& grid, int first_k, int angles)
{
  first_k_ = first_k;
  angles_ = angles;
  cell_x_.resize(static_cast<std::size_t>(angles) * x_.size());
  cell_y_.resize(cell_x_.size());
  extent_ = {};
  if (cell_x_.empty()) return;
  for (int k = first_k; k < first_k + angles; ++k) {
    const double theta = grid.centre.theta + k * grid.theta_step;
    const double turn[4] = {grid.centre.scale * std::cos(theta) / grid.cell_px,
                            grid.centre.scale * std::sin(theta) / grid.cell_px, grid.centre.x / grid.cell_px,
                            grid.centre.y / grid.cell_px};
    floorTurned(x_.data(), y_.data(), size(), turn, cell_x_.data() + index(k), cell_y_.data() + index(k));
  }
  const auto [left, right] = std::minmax_element(cell_x_.begin(), cell_x_.end());
  const auto [top, bottom] = std::minmax_element(cell_y_.begin(), cell_y_.end());
  extent_ = {*left, *top, *right - *left + 1, *bottom - *top + 1};
}

}  // namespace eyeslam::tracking
