// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/vessel_detector.h"

namespace eyeslam::tracking {

struct RidgeDetectorOptions {
  int most_points = 600;
  double least_contrast = 0.03;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("most_points", self.most_points, Range{50, 5000}, "points",
                  "the strongest are kept; source: tracker study 2.5");
    visitor.field("least_contrast", self.least_contrast, Range{0.0, 1.0}, "of the background",
                  "weaker ridges are noise; source: tracker study 2.5");
  }
};

/// The dense alternative to tracing: pixels darker than both flanks, at half the frame's resolution, thinned across the
/// vessel and ranked by contrast (tracker study, 2.5). A threshold that is fixed instead of ranked gives thousands of
/// points of noise on a textured retina; so the threshold follows the number of points, from one frame to the next.
class RidgeDetector : public VesselDetector {
 public:
  explicit RidgeDetector(const RidgeDetectorOptions& options = {});

  void detect(const Frame& frame, const OcclusionMask& mask, VesselPoints& points) override;

 private:
  void shrink(const Frame& frame);
  void respond();
  void collect(const OcclusionMask& mask, VesselPoints& points) const;
  void keepStrongest(VesselPoints& points);

  RidgeDetectorOptions options_;
  int threshold_;  // contrast units; carried over from frame to frame
  cv::Mat_<std::int16_t> small_, smooth_, response_, direction_;
  std::vector<std::int16_t> scratch_;
};

}  // namespace eyeslam::tracking
