// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "eyeslam/retina/options.h"
#include "eyeslam/simulation/fundus.h"

namespace eyeslam::simulation {

struct FundusPhotographOptions {
  double um_per_px = 4.0;
  double surround_level = 20.0;
  double margin_um = 120.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("um_per_px", self.um_per_px, Range{0.1, 100.0}, "um",
                  "width of the photograph's pixel; source: HRF, 45 degrees over 3262 px");
    visitor.field(
        "surround_level", self.surround_level, Range{0.0, 255.0}, "grey levels",
        "darker places at the picture's edge are the camera's black surround; source: HRF, surround under 10");
    visitor.field("margin_um", self.margin_um, Range{0.0, 2000.0}, "um",
                  "width of the dim seam cut off beside the surround; source: our choice, by eye");
  }
};

/// Makes a fundus of any photograph. Its black surround is cut off and filled smoothly, so that no edge of the camera's
/// field ever enters the view.
/// @param bgr      8 bit, 3 channels, at least 64 x 64
/// @param vessels  8 bit, 1 channel, of the photograph's size, not 0 = vessel; empty = no vessel is known
/// @throws std::invalid_argument when types or sizes do not fit, or all is dark
Fundus fundusFromPhotograph(const cv::Mat& bgr, const cv::Mat& vessels, const FundusPhotographOptions& options = {});

/// The local calibre of every vessel pixel of a mask, px: the width of the widest disc within the mask that holds it
/// (local thickness; Hildebrand and Ruegsegger 1997).
/// @param vessels  8 bit, 1 channel, not 0 = vessel
cv::Mat_<float> calibreOfMask(const cv::Mat_<std::uint8_t>& vessels);

}  // namespace eyeslam::simulation
