// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/response_surface.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/tracking/match_kernels.h"

namespace eyeslam::tracking {

PoseBox PoseBox::around(const GridPose& pose, const PoseGrid& grid, int steps, int cells)
{
  return {std::max(pose.k - steps, -grid.half_k), std::min(pose.k + steps, grid.half_k),
          std::max(pose.j - cells, -grid.half_j), std::min(pose.j + cells, grid.half_j),
          std::max(pose.i - cells, -grid.half_i), std::min(pose.i + cells, grid.half_i)};
}

void ResponseSurface::reserve(int poses, int points)
{
  sums_.reserve(static_cast<std::size_t>(poses));
  columns_.reserve(static_cast<std::size_t>(poses));
  offsets_.reserve(static_cast<std::size_t>(points));
}

void ResponseSurface::evaluate(const TurnedPoints& points, const MaxPooledTables& tables, const cv::Point& origin,
                               const PoseBox& box)
{
  box_ = box;
  const int rows = box.j1 - box.j0 + 1;
  width_ = (box.i1 - box.i0 + kSumColumns) / kSumColumns * kSumColumns;
  sums_.resize(static_cast<std::size_t>((box.k1 - box.k0 + 1) * rows * width_));
  columns_.resize(static_cast<std::size_t>(rows * kSumColumns));
  offsets_.resize(static_cast<std::size_t>(points.size()));
  const int stride = static_cast<int>(tables.stride());
  std::uint32_t* first = sums_.data();
  for (int k = box.k0; k <= box.k1; ++k, first += rows * width_) {
    for (std::size_t n = 0; n < offsets_.size(); ++n) {
      offsets_[n] = (points.cellY(k)[n] + box.j0 - origin.y) * stride + points.cellX(k)[n] + box.i0 - origin.x;
    }
    for (int column = 0; column < width_; column += kSumColumns) {
      sumSixteenColumns(tables.cells() + column, stride, offsets_.data(), points.size(), rows, columns_.data());
      for (int r = 0; r < rows; ++r) {
        std::copy_n(columns_.data() + r * kSumColumns, kSumColumns, first + r * width_ + column);
      }
    }
  }
}

GridPose ResponseSurface::best() const
{
  const std::uint32_t most = largestSum();
  GridPose best{box_.k1 + 1, box_.j1 + 1, box_.i1 + 1, 0};
  bool found = false;
  forEachFrom(most, [&](const GridPose& pose) {
    if (!found || isBetter(pose, best)) best = pose;
    found = true;
  });
  return best;
}

std::uint32_t ResponseSurface::largestSum() const
{
  std::uint32_t most = 0;
  const int width = box_.i1 - box_.i0 + 1;
  for (std::size_t row = 0; row < sums_.size(); row += static_cast<std::size_t>(width_)) {
    most = std::max(most, *std::max_element(&sums_[row], &sums_[row] + width));
  }
  return most;
}

Eigen::Matrix3d ResponseSurface::covariance(const PoseGrid& grid, int points, double temperature) const
{
  constexpr double kNegligible = 8.0;  // exp(-8): 1000 such poses weigh a third of the best
  const std::uint32_t most = largestSum();
  const double per_sum = 1.0 / (255.0 * points * temperature);
  const double least = most - kNegligible / per_sum;
  double weights = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  forEachFrom(least > 0.0 ? static_cast<std::uint32_t>(least) : 0, [&](const GridPose& pose) {
    const double weight = std::exp((static_cast<double>(pose.sum) - most) * per_sum);
    const Eigen::Vector3d at(pose.i, pose.j, pose.k);
    weights += weight;
    mean += weight * at;
    square += weight * at * at.transpose();
  });
  mean /= weights;
  const Eigen::Matrix3d of_a_cell = Eigen::Matrix3d::Identity() / 12.0;
  const Eigen::Vector3d unit(grid.cell_px, grid.cell_px, grid.theta_step);
  return unit.asDiagonal() * (square / weights - mean * mean.transpose() + of_a_cell) * unit.asDiagonal();
}

}  // namespace eyeslam::tracking
