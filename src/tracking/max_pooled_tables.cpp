// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/max_pooled_tables.h"

#include <algorithm>

#include "eyeslam/tracking/match_kernels.h"

namespace eyeslam::tracking {

namespace {

constexpr int kRightMargin = 16;  // a kernel reads sixteen columns at once
constexpr int kBoundMargin = 64;  // and thirty-two bounds, the last of them past the planes' end

std::ptrdiff_t strideFor(int width) { return (width + kRightMargin + 15) / 16 * 16; }
std::ptrdiff_t blocksAlong(int cells) { return (cells + MaxPooledTables::kBlock - 1) / MaxPooledTables::kBlock; }
std::size_t length(std::ptrdiff_t count) { return static_cast<std::size_t>(count); }

std::size_t cellBytes(const cv::Size& size)
{
  return length(strideFor(size.width) * (size.height + MaxPooledTables::kBlock) + kRightMargin);
}

std::size_t boundBytes(const cv::Size& size)
{
  constexpr int kPlanes = MaxPooledTables::kBlock * MaxPooledTables::kBlock;
  return length(kPlanes * blocksAlong(size.width) * blocksAlong(size.height) + kBoundMargin);
}

}  // namespace

void MaxPooledTables::reserve(const cv::Size& largest)
{
  cells_.reserve(cellBytes(largest));
  small_.reserve(cellBytes(largest));
  bounds_.reserve(boundBytes(largest));
  scratch_.reserve(length(strideFor(largest.width)));
  pooled_.reserve(length(strideFor(largest.width)));
}

void MaxPooledTables::resize(const cv::Size& size)
{
  size_ = size;
  stride_ = strideFor(size.width);
  bound_stride_ = blocksAlong(size.width);
  plane_size_ = bound_stride_ * blocksAlong(size.height);
  cells_.assign(cellBytes(size), 0);
}

void MaxPooledTables::assign(const OccupancyMap& map, const cv::Rect& cells)
{
  resize(cells.size());
  cv::Mat_<std::uint8_t> window(size_.height, size_.width, cells_.data(), length(stride_));
  map.copyWindow(cells, window);
}

void MaxPooledTables::pool(int first, int end)
{
  if (size_.empty()) return;
  small_.resize(cellBytes(size_));
  bounds_.resize(boundBytes(size_));
  scratch_.resize(length(stride_));
  pooled_.resize(length(stride_));
  // A large window reaches into the small ones of four rows further on.
  const int small_end = std::min(end, size_.height) + kSmallBlock;
  for (int y = first; y < small_end; ++y) poolSmall(row(y), stride_, scratch_.data(), small_.data() + y * stride_);
  for (int y = first; y < end; ++y) {
    poolLarge(small_.data() + y * stride_, stride_, size_.width, pooled_.data());
    spreadOverPlanes(y);
  }
}

void MaxPooledTables::spreadOverPlanes(int y)
{
  for (int phase = 0; phase < kBlock; ++phase) {
    std::uint8_t* plane = bounds_.data() + boundOffset(phase, y);
    const std::ptrdiff_t count = (size_.width - phase + kBlock - 1) / kBlock;
    for (std::ptrdiff_t block = 0; block < count; ++block) plane[block] = pooled_[length(block * kBlock + phase)];
  }
}

}  // namespace eyeslam::tracking
