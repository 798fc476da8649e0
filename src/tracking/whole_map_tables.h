// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/tracking/max_pooled_tables.h"
#include "eyeslam/tracking/occupancy_map.h"

namespace eyeslam::tracking {

/// Max-pooled tables over a whole map and a margin, kept from frame to frame: only bands of rows whose tiles have
/// changed are made again, a limited number in a call. A cell of the tables is the maximum of `reduction` x `reduction`
/// cells.
class WholeMapTables {
 public:
  /// Cells that the tables should not exceed: 3 bytes each, so 50 MB. Callers choose the reduction for it.
  static constexpr std::int64_t kMostCells = 1 << 24;

  /// What the tables cover, their own cells. @param known  cells of the map
  static cv::Rect areaOf(const cv::Rect& known, int reduction, int margin);
  /// Brings the tables closer to the map.
  /// @param margin      cells of the tables around the known rectangle
  /// @param operations  budget of this call in vector operations; at least one band is made
  /// @return whether they are current
  bool update(const OccupancyMap& map, int reduction, int margin, std::int64_t operations);

  const MaxPooledTables& tables() const { return tables_; }
  /// Cell (of the tables' size) of the map at which they begin.
  cv::Point origin() const { return area_.tl(); }

 private:
  bool coversOnly(const cv::Rect& area, int reduction) const;
  bool isCurrent(const OccupancyMap& map, int band) const;
  void make(const OccupancyMap& map, int band);
  cv::Rect rowsOf(int band) const;

  int reduction_ = 0;
  cv::Rect area_;  // cells of the tables
  MaxPooledTables tables_;
  std::vector<std::uint32_t> made_;  // the map's count of changes when each band was made, 0: never
  std::vector<std::uint8_t> copy_;
};

}  // namespace eyeslam::tracking
