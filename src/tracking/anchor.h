// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/alignment_template.h"
#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/mosaic.h"
#include "eyeslam/tracking/occlusion_mask.h"
#include "eyeslam/tracking/refiner.h"

namespace eyeslam::tracking {

struct AnchorOptions {
  int first_frame = 24;
  int last_frame = 3072;
  int slew_frames = 8;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("first_frame", self.first_frame, Range{4, 100000}, "frames",
                  "frame 0 is registered to the mosaic then, and at each doubling; source: tracker study 2.14");
    visitor.field("last_frame", self.last_frame, Range{0, 1000000}, "frames", "no more registrations after it");
    visitor.field("slew_frames", self.slew_frames, Range{1, 1000}, "frames",
                  "a correction is spread over so many, because a servo must not see a step; source: study 6");
  }
};

/// Ties the poses to frame 0. The errors of the first frames are baked into the mosaic; later, when it is better known,
/// frame 0 itself is registered to it, without its own share, and every pose is given relative to the result (tracker
/// study, 2.14 and 6).
class Anchor {
 public:
  Anchor(const AnchorOptions& options, const RefinerOptions& refiner);

  /// Keeps frame 0.
  void start(const Frame& frame, const OcclusionMask& mask);
  /// Registers frame 0 when its turn has come, and moves a step towards the last result.
  void update(const Mosaic& mosaic, std::int64_t frames_since_start);
  /// Starts the mosaic again from frame 0, when it turns out that what was added since had the wrong scale; not when
  /// more than frame 0 would be lost.
  void restore(Mosaic& mosaic) const;
  /// Pose of frame 0 in the mosaic, frame px; near the identity.
  const retina::Pose2& mosaic_T_start() const { return now_; }

 private:
  void collect(const Mosaic& mosaic);
  void pushStrongest(int bx, int by);
  bool isKnown(int x, int y) const;
  void registerStart(const Mosaic& mosaic);

  AnchorOptions options_;
  Refiner refiner_;
  cv::Mat_<std::int16_t> contrast_;
  cv::Mat_<std::uint8_t> hidden_;
  cv::Mat_<std::int16_t> mean_;
  cv::Mat_<std::uint8_t> count_;
  AlignmentTemplate template_;
  retina::Pose2 goal_, now_;
  std::int64_t next_ = 0;
};

}  // namespace eyeslam::tracking
