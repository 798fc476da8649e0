// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/occlusion_mask.h"
#include "eyeslam/tracking/shaft_axis.h"
#include "eyeslam/tracking/shaft_search.h"
#include "eyeslam/tracking/tint_sampler.h"
#include "eyeslam/tracking/track_result.h"

namespace eyeslam::tracking {

struct ToolTipOptions {
  double grey_share = 0.6;
  double bright_share = 1.35;
  double saturated = 225.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("grey_share", self.grey_share, Range{0.3, 0.95}, "of the red",
                  "bluer is steel; source: rendered sequences (retina 0.12-0.35, burn 0.5, steel 0.9-1)");
    visitor.field("bright_share", self.bright_share, Range{1.0, 4.0}, "of the median grey",
                  "grey images: brighter is steel; source: rendered sequences in grey");
    visitor.field("saturated", self.saturated, Range{128.0, 255.0}, "of 255",
                  "bluer is a bloom, which hides the tip; source: rendered sequences (steel's highlight 150-200)");
  }
};

/// Finds the instrument in each frame by itself: axis and width from its edges, the tip where it ends on the axis.
/// No memory of earlier frames: a tip that is reported was seen in this very frame. Grey images show only the bright
/// line along the shaft: width and edges are the line's.
class ToolTipTracker {
 public:
  explicit ToolTipTracker(const ToolTipOptions& options = {});

  /// @param image  the picture that `frame` was made from, whole
  /// @return tip and shaft in full px, valid until the next call; `present == false` when no instrument comes in from
  ///         the border of the lit field and ends within it
  const ToolTip& update(const Frame& frame, const OcclusionMask& mask, const cv::Mat& image);

 private:
  struct End {
    double along = 0.0;  // on the axis
    double variance = 0.0;
  };

  std::optional<ShaftAxis> findAxis(const TintSampler& image, const Shaft& shaft);
  std::optional<End> findEnd(const TintSampler& image, const ShaftAxis& axis) const;
  End seenEnd(const TintSampler& image, const ShaftAxis& axis, double rough) const;
  End hiddenEnd(const TintSampler& image, const ShaftAxis& axis, double from, double to) const;
  double doubtInGlow(const TintSampler& image, const ShaftAxis& axis, double along) const;
  Tint across(const TintSampler& image, const ShaftAxis& axis, double along) const;
  void report(const ShaftAxis& axis, const End& end);

  ToolTipOptions options_;
  ShaftSearch search_;
  ShaftEdges edges_;
  ToolTip tip_;
};

}  // namespace eyeslam::tracking
