// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/block_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "eyeslam/tracking/match_kernels.h"

namespace eyeslam::tracking {

namespace {

constexpr int kBlock = MaxPooledTables::kBlock;
constexpr int kSmall = MaxPooledTables::kSmallBlock;
constexpr int kParts = 5;  // numbers of a large block: itself and its quarters
constexpr std::uint32_t kUnit = MaxPooledTables::kBoundUnit;
constexpr std::size_t kMostKeptRivals = 256;

int blocksFor(int poses) { return (poses + kBlock - 1) / kBlock; }
int widthFor(int blocks) { return (blocks + kBoundColumns - 1) / kBoundColumns * kBoundColumns; }

}  // namespace

void BlockSearch::reserve(int blocks, int points)
{
  bounds_.reserve(static_cast<std::size_t>(blocks));
  offsets_.reserve(static_cast<std::size_t>(points));
  heap_.reserve(4 * static_cast<std::size_t>(blocks));
  rivals_.reserve(kMostKeptRivals);
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
  fillHeap();
  std::int64_t operations = 0;
  while (!heap_.empty() && heap_.front().bound >= threshold()) {
    if (limits.operations >= 0 && operations > limits.operations) break;
    const Block block = pop();
    const bool is_large = block.number % kParts == 0;
    if (is_large) {
      split(block);
    } else {
      computeAll(block, kSmall);
    }
    operations += points.size() * (is_large ? kBlock / kSmall : kSmall);
  }
  complete_ = heap_.empty() || heap_.front().bound < threshold();
  dropRivalsFallenBehind();
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
  const int width = widthFor(block_columns_), per_angle = width * block_rows_;
  bounds_.resize(static_cast<std::size_t>(per_angle * points_->angles()));
  offsets_.resize(static_cast<std::size_t>(points_->size()));
  for (int angle = 0; angle < points_->angles(); ++angle) {
    const int k = points_->firstAngle() + angle;
    for (std::size_t n = 0; n < offsets_.size(); ++n) {
      offsets_[n] = static_cast<std::int32_t>(tables_->boundOffset(points_->cellX(k)[n] - grid_->half_i - origin_.x,
                                                                   points_->cellY(k)[n] - grid_->half_j - origin_.y));
    }
    sumBounds(tables_->bounds(), tables_->boundStride(), offsets_.data(), points_->size(), block_rows_, block_columns_,
              bounds_.data() + angle * per_angle, width);
  }
}

template <class Visit>
void BlockSearch::forEachBlock(int angle, Visit&& visit) const
{
  const int width = widthFor(block_columns_);
  const std::uint16_t* bound = bounds_.data() + angle * width * block_rows_;
  auto number = static_cast<std::uint32_t>(kParts * angle * block_columns_ * block_rows_);
  for (int row = 0; row < block_rows_; ++row, bound += width) {
    for (int column = 0; column < block_columns_; ++column, number += kParts) visit(Block{bound[column], number});
  }
}

// A good score early keeps most blocks out of the heap: the most promising block of every angle is computed first.
void BlockSearch::fillHeap()
{
  for (int angle = 0; angle < points_->angles(); ++angle) {
    Block most_promising{0, 0};
    forEachBlock(angle, [&](const Block& block) {
      if (block.bound > most_promising.bound) most_promising = block;
    });
    if (most_promising.bound * kUnit >= threshold()) computeAll(most_promising, kBlock);
  }
  heap_.clear();
  heap_.reserve(4 * bounds_.size());  // each opened block leaves four
  const std::uint32_t least = (threshold() + kUnit - 1) / kUnit;
  for (int angle = 0; angle < points_->angles(); ++angle) {
    forEachBlock(angle, [&](const Block& block) {
      if (block.bound >= least) heap_.push_back({block.bound * kUnit, block.number});
    });
  }
  std::make_heap(heap_.begin(), heap_.end());
}

void BlockSearch::push(const Block& block)
{
  if (block.bound < threshold()) return;
  heap_.push_back(block);
  std::push_heap(heap_.begin(), heap_.end());
}

BlockSearch::Block BlockSearch::pop()
{
  const Block block = heap_.front();
  std::pop_heap(heap_.begin(), heap_.end());
  heap_.pop_back();
  return block;
}

GridPose BlockSearch::firstPose(const Block& block) const
{
  const int number = static_cast<int>(block.number / kParts), blocks = block_columns_ * block_rows_;
  GridPose first;
  first.k = points_->firstAngle() + number / blocks;
  first.j = number % blocks / block_columns_ * kBlock - grid_->half_j;
  first.i = number % block_columns_ * kBlock - grid_->half_i;
  const int part = static_cast<int>(block.number % kParts);
  if (part > 2) first.j += kSmall;
  if (part == 2 || part == 4) first.i += kSmall;
  return first;
}

void BlockSearch::findOffsets(const GridPose& first)
{
  const int stride = static_cast<int>(tables_->stride());
  const std::int32_t* x = points_->cellX(first.k);
  const std::int32_t* y = points_->cellY(first.k);
  const int shift = (first.j - origin_.y) * stride + first.i - origin_.x;
  for (std::size_t n = 0; n < offsets_.size(); ++n) offsets_[n] = y[n] * stride + x[n] + shift;
}

void BlockSearch::split(const Block& block)
{
  const GridPose first = firstPose(block);
  findOffsets(first);
  std::array<std::uint32_t, 2 * kSumColumns> bounds;
  sumSixteenColumns(tables_->smallBounds(), tables_->stride() * kSmall, offsets_.data(), points_->size(), 2,
                    bounds.data());
  const bool has_right = first.i + kSmall <= grid_->half_i, has_lower = first.j + kSmall <= grid_->half_j;
  push({bounds[0], block.number + 1});
  if (has_right) push({bounds[kSmall], block.number + 2});
  if (has_lower) push({bounds[kSumColumns], block.number + 3});
  if (has_right && has_lower) push({bounds[kSumColumns + kSmall], block.number + 4});
}

void BlockSearch::computeAll(const Block& block, int side)
{
  const GridPose first = firstPose(block);
  findOffsets(first);
  const int columns = std::min(side, grid_->half_i + 1 - first.i), rows = std::min(side, grid_->half_j + 1 - first.j);
  std::array<std::uint32_t, kBlock * kSumColumns> sums;
  sumSixteenColumns(tables_->cells(), tables_->stride(), offsets_.data(), points_->size(), rows, sums.data());
  GridPose best_here{first.k, first.j, first.i, sums[0]};
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const GridPose pose{first.k, first.j + r, first.i + c, sums[static_cast<std::size_t>(r * kSumColumns + c)]};
      if (isBetter(pose, best_here)) best_here = pose;
    }
  }
  if (best_here.sum < threshold()) return;
  keepRival(best_here);
  if (!found_ || isBetter(best_here, best_)) best_ = best_here;
  found_ = true;
}

void BlockSearch::keepRival(const GridPose& pose)
{
  if (rivals_.size() == kMostKeptRivals) dropRivalsFallenBehind();
  if (rivals_.size() < kMostKeptRivals) rivals_.push_back(pose);
}

void BlockSearch::dropRivalsFallenBehind()
{
  const auto fell_behind = [this](const GridPose& rival) { return rival.sum < threshold(); };
  rivals_.erase(std::remove_if(rivals_.begin(), rivals_.end(), fell_behind), rivals_.end());
}

}  // namespace eyeslam::tracking
