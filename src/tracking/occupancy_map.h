// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/occlusion_mask.h"
#include "eyeslam/tracking/tile_grid.h"
#include "eyeslam/tracking/vessel_point.h"

namespace eyeslam::tracking {

struct OccupancyMapOptions {
  double cell_px = 2.0;
  int hit_centre = 60;
  int hit_edge = 40;
  int hit_corner = 30;
  int most_centre = 255;
  int most_edge = 190;
  int most_corner = 140;
  int decay = 12;
  int decay_period = 4;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("cell_px", self.cell_px, Range{0.5, 16.0}, "frame px", "side of a cell; source: tracker study 2.6");
    visitor.field("hit_centre", self.hit_centre, Range{1, 255}, "of 255",
                  "what a point adds to its own cell; source: tracker study 2.6");
    visitor.field("hit_edge", self.hit_edge, Range{0, 255}, "of 255",
                  "what a point adds to the four cells beside it; source: tracker study 2.6");
    visitor.field("hit_corner", self.hit_corner, Range{0, 255}, "of 255",
                  "what a point adds to the four cells across; source: tracker study 2.6");
    visitor.field("most_centre", self.most_centre, Range{1, 255}, "of 255",
                  "own cells saturate here, so that a burn can be forgotten; source: tracker study 2.6");
    visitor.field("most_edge", self.most_edge, Range{0, 255}, "of 255",
                  "cells beside a point saturate here; source: tracker study 2.6");
    visitor.field("most_corner", self.most_corner, Range{0, 255}, "of 255",
                  "cells across a point saturate here; source: tracker study 2.6");
    visitor.field("decay", self.decay, Range{0, 255}, "of 255",
                  "what a cell in plain view loses when its row's turn comes; source: tracker study 2.6");
    visitor.field("decay_period", self.decay_period, Range{1, 64}, "frames",
                  "every row has its turn once in so many frames; source: tracker study 2.6 (a quarter of the rows)");
  }
};

/// The paper's map: the probability, 0 to 255, that a vessel lies in a cell. Cell (i, j) covers the centred map px
/// [i, i + 1) x [j, j + 1) times `cell_px`, i to the right, j down; cells never hit are 0. The map grows in all four
/// directions without moving what it knows, and allocates only when a new tile is touched.
class OccupancyMap {
 public:
  /// Cells further from the origin than this are ignored: a pose gone mad must not fill the memory.
  static constexpr int kReach_cells = 1 << 14;
  static constexpr int kTile = 64;  ///< cells along a tile's side

  struct Tile {
    std::array<std::uint8_t, kTile * kTile> cells{};
    std::uint32_t changes = 0;  ///< the map's `changes()` when the tile was last written
  };

  explicit OccupancyMap(const OccupancyMapOptions& options = {});

  /// Adds the vessel points of one frame (centred frame px). Points that are not finite, or out of reach, are ignored.
  void add(const ScanPoints& points, const retina::Pose2& map_T_frame);
  /// Lowers the cells in view, outside the mask, in the rows whose turn it is. Out of view nobody has looked, so
  /// nothing is known against a vessel there. Cost: the view's area, whatever the map's size.
  /// @param view  size of the frame that `mask` belongs to, frame px
  void decay(const OcclusionMask& mask, const cv::Size& view, const retina::Pose2& map_T_frame, std::int64_t frame);
  void clear();

  bool empty() const { return known_.empty(); }
  double cellSize() const { return options_.cell_px; }
  /// Rectangle around every cell ever hit and its eight neighbours; empty for an empty map.
  const cv::Rect& knownCells() const { return known_; }
  /// Value of one cell, 0 where nothing is known.
  std::uint8_t cell(int i, int j) const;
  /// Copies a rectangle of cells into `window` (made of that size when it is not), 0 where nothing is known.
  void copyWindow(const cv::Rect& cells, cv::Mat_<std::uint8_t>& window) const;
  /// The tiles, for those who keep something derived from them current.
  const TileGrid<Tile>& tiles() const { return tiles_; }
  /// Counts the calls that changed the map.
  std::uint32_t changes() const { return changes_; }
  /// `changes()` after the last `clear`: what was derived before is void, also where no tile is left to tell.
  std::uint32_t clearedAt() const { return cleared_at_; }

 private:
  void hit(int i, int j);
  void raise(int i, int j, int hit, int most);
  void decayRow(const OcclusionMask& mask, const cv::Size& view, const retina::Pose2& frame_T_map, int j,
                const cv::Rect& box);

  OccupancyMapOptions options_;
  TileGrid<Tile> tiles_;
  cv::Rect known_;
  std::uint32_t changes_ = 0;
  std::uint32_t cleared_at_ = 0;
};

}  // namespace eyeslam::tracking
