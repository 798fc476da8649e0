// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/alignment_template.h"
#include "eyeslam/tracking/masked_contrast.h"
#include "eyeslam/tracking/mosaic.h"
#include "eyeslam/tracking/refiner.h"

namespace eyeslam::tracking {

struct ScaleEvidenceOptions {
  int period = 4;
  double least_change = 0.006;
  double sigmas = 4.0;
  int in_a_row = 2;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("period", self.period, Range{1, 1000}, "frames",
                  "the scale is measured once in so many; source: tracker study 2.12");
    visitor.field(
        "least_change", self.least_change, Range{0.0, 1.0}, "",
        "smaller differences from 1 are warp and weak texture; source: rigid rendered sequences stay under 0.0056");
    visitor.field("sigmas", self.sigmas, Range{0.0, 100.0}, "standard deviations",
                  "and as many of the measurement's own; source: a change that counts shows at 30 and more");
    visitor.field("in_a_row", self.in_a_row, Range{1, 100}, "measurements", "of one sign; source: tracker study 2.12");
  }
};

/// Notices that the view is magnified. The scale is free only on evidence, because an idle fourth number costs accuracy
/// where texture is weak (tracker study, 2.12). Frames are measured against the first frame's own picture: the mosaic
/// follows a slow change of scale and would hide it. Where the first frame is out of view, the mosaic serves.
class ScaleEvidence {
 public:
  ScaleEvidence(const ScaleEvidenceOptions& options, const RefinerOptions& refiner);

  /// Keeps frame 0, whose mosaic this is.
  void start(const MaskedContrast& frame, const Mosaic& mosaic);
  /// Looks at a localized frame when its turn has come.
  /// @return whether the view turned out to be magnified just now
  bool update(const MaskedContrast& frame, const Mosaic& mosaic, const retina::Pose2& map_T_frame, std::int64_t number);
  /// Whether the scale must be estimated; once true it stays.
  bool isMagnified() const { return magnified_; }

 private:
  ScaleEvidenceOptions options_;
  Refiner refiner_;
  AlignmentTemplate first_, seen_;
  int in_a_row_ = 0;
  double last_change_ = 0.0;
  bool magnified_ = false;
};

}  // namespace eyeslam::tracking
