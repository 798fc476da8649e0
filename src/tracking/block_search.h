// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "eyeslam/tracking/max_pooled_tables.h"
#include "eyeslam/tracking/turned_points.h"

namespace eyeslam::tracking {

/// Best-first branch and bound over a grid of poses: blocks of 8 x 8 shifts, largest bound first, every pose of an
/// opened block computed, until no bound reaches the best score. Exact: what is not opened cannot hold the answer.
/// Source: Olson 2009, Hess et al. 2016 (facts A3); unlike theirs, all blocks are bounded at once by vector sums, which
/// costs less here than levels above them would save.
class BlockSearch {
 public:
  struct Limits {
    std::uint32_t least_sum = 0;   ///< poses below this are of no interest
    double rival_ratio = 1.0;      ///< blocks are opened down to this share of the best, to see rivals; at most 1
    std::int64_t operations = -1;  ///< vector operations for opening blocks; negative: no limit
  };

  void reserve(int blocks, int points);
  /// Searches the angles to which the points are turned.
  /// @param grid    of the points
  /// @param tables  pooled; hold every cell that a point touches from the grid
  /// @param origin  cell of the map at which the tables begin
  void search(const PoseGrid& grid, const TurnedPoints& points, const MaxPooledTables& tables, const cv::Point& origin,
              const Limits& limits);

  /// Whether a pose of at least `least_sum` was seen.
  bool found() const { return found_; }
  const GridPose& best() const { return best_; }
  /// Whether the search came to its end, so that `best` is the best of all and `rivals` are complete.
  bool complete() const { return complete_; }
  /// The best pose of each opened block that reaches rival_ratio of the best; at most 256, then only the first seen.
  const std::vector<GridPose>& rivals() const { return rivals_; }

  /// Vector operations that bounding the blocks of one angle takes.
  static std::int64_t operationsPerAngle(const PoseGrid& grid, int points);

 private:
  struct Block {
    std::uint32_t bound;   // no pose of the block sums to more
    std::uint32_t number;  // 5 x that of the large block, plus 0 for itself, 1 to 4 for a quarter of it
    // Largest bound on top of the heap; of equal ones the lowest number, so that the order is always the same.
    bool operator<(const Block& other) const
    {
      return bound != other.bound ? bound < other.bound : number > other.number;
    }
  };

  void boundBlocks();
  template <class Visit>
  void forEachBlock(int angle, Visit&& visit) const;
  void fillHeap();
  void push(const Block& block);
  Block pop();
  GridPose firstPose(const Block& block) const;
  void findOffsets(const GridPose& first);
  void split(const Block& block);
  void computeAll(const Block& block, int side);
  void keepRival(const GridPose& pose);
  void dropRivalsFallenBehind();
  std::uint32_t threshold() const;

  const PoseGrid* grid_ = nullptr;  // of the search that runs
  const TurnedPoints* points_ = nullptr;
  const MaxPooledTables* tables_ = nullptr;
  cv::Point origin_;
  Limits limits_;
  int block_columns_ = 0;
  int block_rows_ = 0;

  bool found_ = false;
  bool complete_ = false;
  GridPose best_;
  std::vector<GridPose> rivals_;
  std::vector<std::uint16_t> bounds_;
  std::vector<Block> heap_;
  std::vector<std::int32_t> offsets_;
};

}  // namespace eyeslam::tracking
