// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/occlusion_mask.h"
#include "eyeslam/tracking/vessel_point.h"

namespace eyeslam::tracking {

struct SpuriousDetectionFilterOptions {
  double darkest_red = 0.40;
  double least_redness = 0.42;
  double bloom_whiteness = 0.70;
  int bloom_distance_cells = 3;
  int rim_distance_cells = 1;
  int instrument_distance_cells = 5;
  double instrument_angle_deg = 30.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("darkest_red", self.darkest_red, Range{0.0, 1.0}, "of the median red",
                  "colour test: darker is no retina; source: paper, colour test, above the mask's 0.35");
    visitor.field("least_redness", self.least_redness, Range{0.0, 1.0}, "of red + green + blue",
                  "colour test: less red is no retina; source: paper, colour test (grey is 0.33, the disc 0.5)");
    visitor.field(
        "bloom_whiteness", self.bloom_whiteness, Range{0.0, 1.0}, "of red",
        "cells brighter than the median with so much green and blue are bloom; source: rendered blooms are 1");
    visitor.field("bloom_distance_cells", self.bloom_distance_cells, Range{0, 16}, "cells of 4 px",
                  "bloom proximity: points so near are removed; source: paper, bloom proximity test");
    visitor.field("rim_distance_cells", self.rim_distance_cells, Range{0, 16}, "cells of 4 px",
                  "points so near the mask's rim are removed; source: paper, mask over the dark ring");
    visitor.field("instrument_distance_cells", self.instrument_distance_cells, Range{0, 16}, "cells of 4 px",
                  "points so near a bright edge are removed when they run along it; source: facts A6, tool edges");
    visitor.field("instrument_angle_deg", self.instrument_angle_deg, Range{0.0, 90.0}, "deg",
                  "how far along the edge is; source: the tracer's directions are good to some 10 deg");
  }
};

/// Culling after the paper: removes vessel points that something else explains. Colour test (too dark, or not red
/// enough), proximity of a large white bloom, of the dark rim, and lines along the edge of the instrument or its
/// shadow. A grey frame has no colour test. No allocation after the first frame of a size.
class SpuriousDetectionFilter {
 public:
  /// How many points each test removed.
  struct Removed {
    int colour = 0;
    int bloom = 0;
    int rim = 0;
    int instrument = 0;
  };

  explicit SpuriousDetectionFilter(const SpuriousDetectionFilterOptions& options = {});

  /// Erases points in place; the others keep their order.
  Removed removeFrom(VesselPoints& points, const Frame& frame, const OcclusionMask& mask);

 private:
  void markCells(const Frame& frame, const OcclusionMask& mask);
  bool runsAlongBrightEdge(const VesselPoint& point, const OcclusionMask& mask) const;

  SpuriousDetectionFilterOptions options_;
  cv::Mat_<std::uint8_t> marks_;  // bits of what is said against a cell
  cv::Mat_<std::uint8_t> scratch_;
};

}  // namespace eyeslam::tracking
