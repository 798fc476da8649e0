// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/tracking/occupancy_map.h"

namespace eyeslam::tracking {

/// A dense rectangle of cells, and for every cell the maxima of the 4 x 4 and the 8 x 8 cells that begin there.
///
/// The bound of a cell is the maximum over a window that *slides* cell by cell: a maximum over fixed squares would be
/// too small for the points whose square is crossed inside a block of poses, and the search would no longer be exact
/// (facts A3.3). A point that lies in cell (x, y) for the first pose of a block of 8 x 8 whole-cell shifts lies in the
/// window of (x, y) for all of them, so the sum of the points' bounds bounds the score of all 64.
///
/// The 4 x 4 maxima lie like the cells. The 8 x 8 ones are rounded up to sixteenths and stored in 64 planes by (x mod
/// 8, y mod 8): neighbouring blocks then lie side by side in memory, and the bounds of a whole row of blocks are sums
/// of contiguous bytes.
class MaxPooledTables {
 public:
  static constexpr int kBlock = 8;       ///< poses along a block's side
  static constexpr int kSmallBlock = 4;  ///< and along a small one's
  static constexpr int kBoundUnit = 16;  ///< a bound of b says: no cell in the window is over 16 b

  /// Takes memory for rectangles of up to so many cells.
  void reserve(const cv::Size& largest);
  /// Makes the rectangle `width` x `height`, all 0. Bounds are not current afterwards.
  void resize(const cv::Size& size);
  /// Copies a rectangle of the map. Bounds are not current afterwards.
  void assign(const OccupancyMap& map, const cv::Rect& cells);
  /// Makes the bounds of the rows [first, end) current.
  void pool(int first, int end);
  void pool() { pool(0, size_.height); }

  const cv::Size& size() const { return size_; }
  std::uint8_t* row(int y) { return cells_.data() + y * stride(); }
  /// Cell (x, y) is at x + y * stride(). 16 columns and 8 rows of zeros follow the rectangle and may be read.
  const std::uint8_t* cells() const { return cells_.data(); }
  std::ptrdiff_t stride() const { return stride_; }

  /// Maximum of the 4 x 4 cells from (x, y) on, at x + y * stride().
  const std::uint8_t* smallBounds() const { return small_.data(); }
  /// Bounds of the blocks (x, y), (x + 8, y), ... are side by side from here; those of (x, y + 8) are `boundStride()`
  /// on.
  const std::uint8_t* bounds() const { return bounds_.data(); }
  std::ptrdiff_t boundOffset(int x, int y) const
  {
    return plane_size_ * ((y % kBlock) * kBlock + x % kBlock) + bound_stride_ * (y / kBlock) + x / kBlock;
  }
  std::ptrdiff_t boundStride() const { return bound_stride_; }

 private:
  void spreadOverPlanes(int y);

  cv::Size size_;
  std::ptrdiff_t stride_ = 0;
  std::ptrdiff_t bound_stride_ = 0;
  std::ptrdiff_t plane_size_ = 0;
  std::vector<std::uint8_t> cells_, small_, bounds_;
  std::vector<std::uint8_t> scratch_, pooled_;
};

}  // namespace eyeslam::tracking
