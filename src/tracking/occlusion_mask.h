// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/frame.h"

namespace eyeslam::tracking {

struct OcclusionMaskOptions {
  double rim_red = 0.35;
  double bright_blue = 0.45;
  double bright_grey = 1.6;
  int growth_cells = 2;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("rim_red", self.rim_red, Range{0.0, 1.0}, "of the median red",
                  "darker cells are rim or shadow; source: tracker study 2.3 (0.35 to 0.6 alike)");
    visitor.field("bright_blue", self.bright_blue, Range{0.0, 2.0}, "of the cell's red",
                  "bluer cells are instrument or bloom; source: tracker study 2.3 (retina 0.12-0.25, disc 0.3)");
    visitor.field("bright_grey", self.bright_grey, Range{1.0, 8.0}, "of the median grey",
                  "grey images: brighter cells are instrument or bloom; source: rendered sequences in grey");
    visitor.field("growth_cells", self.growth_cells, Range{0, 8}, "cells of 4 px",
                  "both masks are grown by it; source: tracker study 2.3 (1 to 4 alike)");
  }
};

/// Which cells of a frame show retina, and what hides the others: dark rim, instrument, bloom.
class OcclusionMask {
 public:
  enum Cell : std::uint8_t { kVisible = 0, kRim = 1, kBright = 2 };  // bits; kBright = instrument or bloom

  explicit OcclusionMask(const OcclusionMaskOptions& options = {});

  void update(const Frame& frame);

  /// Bits of `Cell` for each cell of the frame (4 x 4 frame px), grown.
  const cv::Mat_<std::uint8_t>& cells() const { return cells_; }
  /// The bright cells before growth: instrument and blooms as they are, for the tip.
  const cv::Mat_<std::uint8_t>& brightCells() const { return bright_; }
  /// Whether a frame pixel shows retina; false outside the frame.
  bool isVisible(int x, int y) const
  {
    return x >= 0 && y >= 0 && x < width_ && y < height_ && cells_(y / Frame::kCell, x / Frame::kCell) == kVisible;
  }
  /// Share of the cells that show retina.
  double visibleFraction() const { return visible_fraction_; }
  /// Median red over the cells that are not black (0 to 255): the level of the light.
  int medianRed() const { return median_red_; }

 private:
  OcclusionMaskOptions options_;
  int width_ = 0;
  int height_ = 0;
  int median_red_ = 0;
  double visible_fraction_ = 0.0;
  cv::Mat_<std::uint8_t> cells_, bright_, rough_, scratch_;
};

}  // namespace eyeslam::tracking
