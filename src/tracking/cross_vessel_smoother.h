// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/occlusion_mask.h"
#include "eyeslam/tracking/vessel_point.h"

namespace eyeslam::tracking {

struct CrossVesselSmootherOptions {
  double width_share = 1.0;
  int reach_px = 3;
  int along_px = 2;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field(
        "width_share", self.width_share, Range{0.2, 2.0}, "of the calibre",
        "width of the average across the vessel; source: a box as wide as the vessel is darkest in its middle");
    visitor.field("reach_px", self.reach_px, Range{1, 6}, "frame px",
                  "how far a point may move to the middle; source: the tracer's steps and templates err by up to 2 px");
    visitor.field(
        "along_px", self.along_px, Range{0, 4}, "frame px",
        "three samples are averaged along the vessel, so far apart; source: the length of the tracer's templates");
  }
};

/// The paper's averaging filter across the vessel after tracing: the templates are coarse, so each point is moved along
/// its normal to where the average over the vessel's width is darkest, to a fraction of a pixel.
/// Works on `Frame::contrast()`; about 0.1 us a point. Allocates nothing, keeps nothing between frames.
class CrossVesselSmoother {
 public:
  explicit CrossVesselSmoother(const CrossVesselSmootherOptions& options = {});

  /// Moves `points` (position only). A point without a dark middle within reach stays, as does one
  /// whose middle is masked or that is too near the border to be averaged.
  void smoothAcross(VesselPoints& points, const Frame& frame, const OcclusionMask& mask) const;

 private:
  CrossVesselSmootherOptions options_;
};

}  // namespace eyeslam::tracking
