// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/alignment_template.h"
#include "eyeslam/tracking/dense_search.h"
#include "eyeslam/tracking/masked_contrast.h"
#include "eyeslam/tracking/mosaic.h"
#include "eyeslam/tracking/refiner.h"
#include "eyeslam/tracking/smear_model.h"

namespace eyeslam::tracking {

struct AnchorOptions {
  int first_frame = 24;
  int last_frame = 3072;
  int slew_frames = 8;
  int settle_frames = 4;
  double sharper = 1.15;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("first_frame", self.first_frame, Range{4, 100000}, "frames",
                  "frame 0 is registered to the mosaic then, and at each doubling; source: tracker study 2.14");
    visitor.field("last_frame", self.last_frame, Range{0, 1000000}, "frames",
                  "no more registrations after it; source: our choice, the last doubling of 24 in 100 s");
    visitor.field("slew_frames", self.slew_frames, Range{1, 1000}, "frames",
                  "a correction is spread over so many, because a servo must not see a step; source: study 6");
    visitor.field("settle_frames", self.settle_frames, Range{0, 100}, "frames",
                  "after the first one, in which a sharper one may take its place; source: a saccade lasts 3 frames");
    visitor.field("sharper", self.sharper, Range{1.0, 10.0}, "times the gradient of the start",
                  "that makes a frame so much better to start from; source: rendered saccades 1.2 to 2.3, drift 1.1");
  }
};

/// Ties the poses to frame 0. The errors of the first frames are baked into the mosaic; later, when it is better known,
/// frame 0 itself is registered to it, without its own share, and every pose is given relative to the result (tracker
/// study, 2.14 and 6). Where frame 0 is smeared, the map starts again from a sharper frame, and frame 0 is registered
/// to that one's mosaic with the smear model.
class Anchor {
 public:
  Anchor(const AnchorOptions& options, const RefinerOptions& refiner, const SmearModelOptions& smear,
         const DenseSearchOptions& dense);

  /// Keeps frame 0, which makes the mosaic.
  void start(const MaskedContrast& frame);
  /// Whether this frame, one of the first, is so much sharper than the one the map started from that it should start
  /// from this one instead.
  bool isBetterStart(const MaskedContrast& frame, std::int64_t frames_since_start) const;
  /// Finds frame 0 in a mosaic that was started again from a sharper frame, this one.
  void startAgain(const MaskedContrast& frame, const Mosaic& mosaic, std::int64_t frames_since_start);
  /// Registers frame 0 when its turn has come, and moves a step towards the last result.
  void update(const Mosaic& mosaic, std::int64_t frames_since_start);
  /// Starts the mosaic again from frame 0, when it turns out that what was added since had the wrong scale; not when
  /// more than frame 0 would be lost.
  void restore(Mosaic& mosaic) const;
  /// Pose of frame 0 in the mosaic, frame px; near the identity unless the map was started again.
  const retina::Pose2& mosaic_T_start() const { return now_; }

 private:
  MaskedContrast picture() const { return {contrast_, hidden_}; }
  void registerStart(const Mosaic& mosaic);
  Refinement registerSharp(const Mosaic& mosaic);
  Refinement registerSmeared(const Mosaic& mosaic, const retina::Pose2& from);
  void collect(const Mosaic& mosaic);

  AnchorOptions options_;
  Refiner refiner_;
  SmearModel smear_model_;
  DenseSearch dense_search_;
  cv::Mat_<std::int16_t> contrast_;
  cv::Mat_<std::uint8_t> hidden_;
  double sharpness_ = 0.0;  // of the frame that the map started from
  bool smeared_ = false;
  AlignmentTemplate template_;
  Eigen::Vector2d motion_ = Eigen::Vector2d::Zero();  // of the view in frame 0, map px per frame
  retina::Pose2 goal_, now_;
  std::int64_t next_ = 0;
};

}  // namespace eyeslam::tracking
