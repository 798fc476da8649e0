// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/pose2.h"

namespace eyeslam::tracking {

struct PoseUncertaintyOptions {
  double mosaic_share = 6.0;
  double distance_growth = 8.0;
  double noise_growth = 11.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field(
        "mosaic_share", self.mosaic_share, Range{1.0, 100.0}, "times the variance",
        "the mosaic's own error, alike in all frames; source: docs/results.md, squared errors over 20 sequences");
    visitor.field("distance_growth", self.distance_growth, Range{0.0, 1000.0}, "per squared width of the view",
                  "ground far from frame 0 was registered to ground nearer to it; source: as mosaic_share");
    visitor.field("noise_growth", self.noise_growth, Range{0.0, 1000.0}, "per squared share of noise",
                  "weak texture is compressed alike in successive frames; source: as mosaic_share");
  }
};

/// The honest covariance of a refined pose. A refinement knows how well this frame fits the mosaic; it cannot know the
/// errors that the mosaic shares with it. Those were measured: mean normalised squared error 3 over sequences with
/// truth, constant offset removed.
/// @param refined  covariance of (x, y, theta) that the refinement gave
/// @param ncc      correlation of frame and mosaic; 1 - ncc^2 is the share of noise
Eigen::Matrix3d honestCovariance(const Eigen::Matrix3d& refined, double ncc, const retina::Pose2& map_T_frame,
                                 const cv::Size& frame, const PoseUncertaintyOptions& options);

}  // namespace eyeslam::tracking
