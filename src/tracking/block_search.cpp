// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/block_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "eyeslam/tracking/match_kernels.h"

namespace eyeslam::tracking {

namespace {

constexpr int kBlock = MaxPooledTables::kBlock;
constexpr int kColumns = 16;       // of the summing kernel
constexpr int kBoundColumns = 32;  // of the bounding kernel
constexpr std::size_t kMostRivals = 256;

int blocksFor(int poses) { return (poses + kBlock - 1) / kBlock; }
int widthFor(int blocks) { return (blocks + kBoundColumns - 1) / kBoundColumns * kBoundColumns; }

}  // namespace

void BlockSearch::reserve(int blocks, int points)
{
  bounds_.reserve(static_cast<std::size_t>(blocks));
  offsets_.reserve(static_cast<std::size_t>(points));
  heap_.reserve(static_cast<std::size_t>(blocks));
  rivals_.reserve(kMostRivals);
}

std::int64_t BlockSearch::operationsPerAngle(const PoseGrid& grid, int points)
{
  return std::int64_t{points} * blocksFor(grid.rows()) * (widthFor(blocksFor(grid.columns())) / kBoundColumns);
}

void BlockSearch::search(const PoseGrid& grid, const TurnedPoints& points, const MaxPooledTables& tables,
                         const cv::Point& origin, const Limits& limits)
{
  grid_ = &grid;
  points_ = &points;
  tables_ = &tables;
  origin_ = origin;
  limits_ = limits;
  found_ = false;
  rivals_.clear();
  boundBlocks();
  std::int64_t operations = limits.operations;
  while (!heap_.empty() && std::uint32_t{heap_.front().bound} * MaxPooledTables::kBoundUnit >= threshold()) {
    if (limits.operations >= 0 && (operations -= points.size() * kBlock) < 0) break;
    const Block block = heap_.front();
    std::pop_heap(heap_.begin(), heap_.end());
    heap_.pop_back();
    open(block);
  }
  complete_ = heap_.empty() || std::uint32_t{heap_.front().bound} * MaxPooledTables::kBoundUnit < threshold();
  const auto fell_behind = [this](const GridPose& rival) { return rival.sum < threshold(); };
  rivals_.erase(std::remove_if(rivals_.begin(), rivals_.end(), fell_behind), rivals_.end());
}

std::uint32_t BlockSearch::threshold() const
{
  if (!found_) return limits_.least_sum;
  return std::max(limits_.least_sum, static_cast<std::uint32_t>(std::ceil(best_.sum * limits_.rival_ratio)));
}

void BlockSearch::boundBlocks()
{
  block_columns_ = blocksFor(grid_->columns());
  block_rows_ = blocksFor(grid_->rows());
  const int width = widthFor(block_columns_);
  bounds_.resize(static_cast<std::size_t>(width * block_rows_));
  offsets_.resize(static_cast<std::size_t>(points_->size()));
  heap_.clear();
  std::uint32_t index = 0;
  const std::uint32_t least = (limits_.least_sum + MaxPooledTables::kBoundUnit - 1) / MaxPooledTables::kBoundUnit;
  for (int angle = 0; angle < points_->angles(); ++angle) {
    const int k = points_->firstAngle() + angle;
    for (std::size_t n = 0; n < offsets_.size(); ++n) {
      offsets_[n] = static_cast<std::int32_t>(tables_->boundOffset(points_->cellX(k)[n] - grid_->half_i - origin_.x,
                                                                   points_->cellY(k)[n] - grid_->half_j - origin_.y));
    }
    sumBounds(tables_->bounds(), tables_->boundStride(), offsets_.data(), points_->size(), block_rows_, block_columns_,
              bounds_.data(), width);
    for (int row = 0; row < block_rows_; ++row) {
      for (int column = 0; column < block_columns_; ++column, ++index) {
        const std::uint16_t bound = bounds_[static_cast<std::size_t>(row * width + column)];
        if (bound >= least) heap_.push_back({bound, index});
      }
    }
  }
  std::make_heap(heap_.begin(), heap_.end());
}

void BlockSearch::open(const Block& block)
{
  const int blocks = block_columns_ * block_rows_;
  const int number = static_cast<int>(block.index);
  GridPose first;
  first.k = points_->firstAngle() + number / blocks;
  first.j = number % blocks / block_columns_ * kBlock - grid_->half_j;
  first.i = number % block_columns_ * kBlock - grid_->half_i;
  const int stride = static_cast<int>(tables_->stride());
  for (std::size_t n = 0; n < offsets_.size(); ++n) {
    offsets_[n] =
        (points_->cellY(first.k)[n] + first.j - origin_.y) * stride + points_->cellX(first.k)[n] + first.i - origin_.x;
  }
  judge(first, std::min(kBlock, grid_->half_i + 1 - first.i), std::min(kBlock, grid_->half_j + 1 - first.j));
}

void BlockSearch::judge(const GridPose& first, int columns, int rows)
{
  std::array<std::uint32_t, kBlock * kColumns> sums;
  sumSixteenColumns(tables_->cells(), tables_->stride(), offsets_.data(), points_->size(), rows, sums.data());
  GridPose best_here;
  bool any = false;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const GridPose pose{first.k, first.j + r, first.i + c, sums[static_cast<std::size_t>(r * kColumns + c)]};
      if (!any || isBetter(pose, best_here)) best_here = pose;
      any = true;
    }
  }
  if (best_here.sum < threshold()) return;
  keepRival(best_here);
  if (!found_ || isBetter(best_here, best_)) best_ = best_here;
  found_ = true;
}

void BlockSearch::keepRival(const GridPose& pose)
{
  if (rivals_.size() == kMostRivals) {
    const auto fell_behind = [this](const GridPose& rival) { return rival.sum < threshold(); };
    rivals_.erase(std::remove_if(rivals_.begin(), rivals_.end(), fell_behind), rivals_.end());
  }
  if (rivals_.size() < kMostRivals) rivals_.push_back(pose);
}

}  // namespace eyeslam::tracking
