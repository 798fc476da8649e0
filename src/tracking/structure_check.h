// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/occlusion_mask.h"

namespace eyeslam::tracking {

struct StructureCheckOptions {
  double least_structure = 6.0;
  double least_growth = 1.6;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("least_structure", self.least_structure, Range{0.0, 1000.0}, "times what white noise has",
                  "least variance between areas of 16 px; 0 = any; source: noise 1, blurred over 2 px 4; 22 "
                  "sequences and 8 photographs, down to 128 x 85 px: from 18");
    visitor.field("least_growth", self.least_growth, Range{0.0, 100.0}, "times",
                  "least growth of it from areas of 8 px to those of 32 px, in views of 40 of these; 0 = any; source: "
                  "noise of any blur 0.8 to 1.4; 22 sequences and 8 photographs: from 2.1");
  }
};

/// Tells a retina from noise, for the first frame, which nothing else can judge: ridges of noise look like vessels.
/// The variance of brightness between areas is compared with that within them. Noise averages out in larger areas,
/// and where it was blurred the comparison has one value for all areas larger than the blur; a retina is uneven at
/// every size: vessels, disc, macula, falling light. In views of fewer than 40 areas of 32 px only the first is asked,
/// so noise blurred over more than 2.5 frame px passes there.
class StructureCheck {
 public:
  explicit StructureCheck(const StructureCheckOptions& options = {}) : options_(options) {}

  /// Whether the visible part of a frame may be noise. Looks once at every cell; allocates nothing.
  bool isNoise(const Frame& frame, const OcclusionMask& mask) const;

  /// Variance between areas of `cells` x `cells` cells over that within them: 1 for white noise of any strength.
  struct Unevenness {
    int areas = 0;  ///< at least half visible
    double ratio = 0.0;
  };
  static Unevenness unevenness(const Frame& frame, const OcclusionMask& mask, int cells);

 private:
  StructureCheckOptions options_;
};

}  // namespace eyeslam::tracking
