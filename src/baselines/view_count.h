// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/occlusion_mask.h"
#include "eyeslam/tracking/tile_grid.h"

namespace eyeslam::baselines {

/// In how many frames each cell of a grid was in view and unoccluded, at most 255: cells as those of OccupancyMap.
class ViewCount {
 public:
  explicit ViewCount(double cell_px) : cell_px_(cell_px) {}

  /// Counts one frame. @param map_T_frame  centred frame px
  void add(const tracking::OcclusionMask& mask, const cv::Size& frame, const retina::Pose2& map_T_frame);
  std::uint8_t at(int i, int j) const;

 private:
  static constexpr int kTile = 64;
  using Tile = std::array<std::uint8_t, kTile * kTile>;

  double cell_px_;
  tracking::TileGrid<Tile> tiles_;
};

}  // namespace eyeslam::baselines
