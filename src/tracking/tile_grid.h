// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace eyeslam::tracking {

/// An unbounded plane of square tiles, allocated where first touched: it grows in all four directions and never copies
/// what is already there. Looking a tile up costs two subtractions and a pointer.
template <class Tile>
class TileGrid {
 public:
  /// The tile at tile coordinates (tx, ty), or null where nothing was ever written.
  Tile* find(int tx, int ty) const
  {
    const int column = tx - first_x_;
    const int row = ty - first_y_;
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return nullptr;
    return tiles_[index(column, row)].get();
  }

  /// The tile at (tx, ty), made when it does not exist.
  Tile& at(int tx, int ty)
  {
    include(tx, ty);
    auto& tile = tiles_[index(tx - first_x_, ty - first_y_)];
    if (!tile) tile = std::make_unique<Tile>();
    return *tile;
  }

  bool empty() const { return columns_ == 0; }
  void clear() { *this = TileGrid(); }
  // Bounding box of the directory, tile coordinates, ends excluded; tiles inside may be null.
  int firstX() const { return first_x_; }
  int firstY() const { return first_y_; }
  int endX() const { return first_x_ + columns_; }
  int endY() const { return first_y_ + rows_; }

 private:
  std::size_t index(int column, int row) const
  {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  // Only the directory of pointers moves when it grows.
  void include(int tx, int ty)
  {
    if (columns_ > 0 && tx >= first_x_ && ty >= first_y_ && tx < endX() && ty < endY()) return;
    TileGrid grown;
    grown.first_x_ = columns_ ? std::min(first_x_, tx) : tx;
    grown.first_y_ = columns_ ? std::min(first_y_, ty) : ty;
    grown.columns_ = (columns_ ? std::max(endX(), tx + 1) : tx + 1) - grown.first_x_;
    grown.rows_ = (columns_ ? std::max(endY(), ty + 1) : ty + 1) - grown.first_y_;
    grown.tiles_.resize(static_cast<std::size_t>(grown.columns_) * static_cast<std::size_t>(grown.rows_));
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        grown.tiles_[grown.index(column + first_x_ - grown.first_x_, row + first_y_ - grown.first_y_)] =
            std::move(tiles_[index(column, row)]);
      }
    }
    *this = std::move(grown);
  }

  int first_x_ = 0;
  int first_y_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::unique_ptr<Tile>> tiles_;
};

/// Floor of a / b for b > 0, also for negative a.
constexpr int floorDivide(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

}  // namespace eyeslam::tracking
