// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace eyeslam::retina {

/// The published vessel map as a value: what tracking hands to guidance, files and messages (contracts, section 3).
/// Row-major grids of `width` x `height` cells. The centre of cell (0, 0) lies at (origin_x, origin_y) in the map
/// frame, full-resolution px; neighbouring cells are `px_per_cell` full-resolution px apart.
struct VesselMap {
  int width = 0;
  int height = 0;
  double origin_x = 0.0;
  double origin_y = 0.0;
  double px_per_cell = 1.0;
  double um_per_px = 0.0;                 ///< of full-resolution map px; 0 = unknown
  std::vector<std::uint8_t> probability;  ///< 255 = certainly a vessel, 128 = the threshold; vessels in full width
  std::vector<std::uint8_t> calibre_px;   ///< local vessel width in full-resolution px where probability >= 128, else 0
  std::vector<std::uint8_t> seen;         ///< in how many frames the cell was in view and unoccluded, at most 255
  std::uint64_t version = 0;              ///< grows whenever a cell changed

  bool empty() const { return width == 0 || height == 0; }
  std::size_t index(int column, int row) const
  {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
};

/// A map point of the paper's list M: the cells at or above the threshold.
struct MapPoint {
  double x_px = 0.0;  ///< map frame, full-resolution px
  double y_px = 0.0;
  double probability = 0.0;  ///< [0, 1]
  double calibre_px = 0.0;
};

/// All cells of probability 128 and more, row by row.
std::vector<MapPoint> vesselPoints(const VesselMap& map);

}  // namespace eyeslam::retina
