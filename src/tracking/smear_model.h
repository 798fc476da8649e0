// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/alignment_template.h"
#include "eyeslam/tracking/masked_contrast.h"
#include "eyeslam/tracking/mosaic.h"
#include "eyeslam/tracking/refiner.h"

namespace eyeslam::tracking {

struct SmearModelOptions {
  double least_motion_px = 4.0;
  double ncc_share = 0.95;
  double least_ncc = 0.15;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("least_motion_px", self.least_motion_px, Range{0.0, 1000.0}, "px",
                  "a slower view is not smeared; source: tracker study 2.11");
    visitor.field("ncc_share", self.ncc_share, Range{0.0, 1.0}, "of the running mean",
                  "a frame that correlates better is not smeared; source: tracker study 2.11");
    visitor.field("least_ncc", self.least_ncc, Range{0.0, 1.0}, "",
                  "below it the sharp template is at a wrong place; source: saccades, wrong to 0.11, right from 0.21");
  }
};

/// A view that moves during the exposure shows the mosaic smeared along its motion; so the template is smeared alike,
/// over the share of the last frame's motion that fits best, and the pose is the middle of the exposure (tracker study,
/// 2.11). The share may exceed one: a saccade that has just begun is faster than the step that it has made so far.
class SmearModel {
 public:
  SmearModel(const SmearModelOptions& options, const RefinerOptions& refiner);

  const SmearModelOptions& options() const { return options_; }
  /// @param sharp   the template at `start`
  /// @param motion  of the view since the last frame, map px
  /// @return the refinement of the best smeared template
  Refinement refine(const Mosaic& mosaic, const MaskedContrast& frame, const AlignmentTemplate& sharp,
                    const retina::Pose2& start, const Eigen::Vector2d& motion, Freedom freedom, double scale_sigma);

 private:
  void shapeWindow();
  void smear(const AlignmentTemplate& sharp, const Eigen::Vector2d& extent, std::size_t stride,
             AlignmentTemplate& smeared) const;

  SmearModelOptions options_;
  Refiner quick_;
  Refiner full_;
  cv::Rect region_;  // of the mosaic that was read
  Eigen::Vector2d mosaic_centre_ = Eigen::Vector2d::Zero();
  std::vector<std::int16_t> mean_store_;
  std::vector<std::uint8_t> count_store_;
  cv::Mat_<std::int16_t> mean_;
  cv::Mat_<std::uint8_t> count_;
  AlignmentTemplate smeared_;
};

}  // namespace eyeslam::tracking
