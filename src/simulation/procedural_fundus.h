// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/retina/options.h"
#include "eyeslam/simulation/fundus.h"
#include "eyeslam/simulation/vessel_tree.h"

namespace eyeslam::simulation {

/// A retina that nobody photographed.
struct ProceduralFundusOptions {
  double um_per_px = 5.0;
  double width_mm = 14.0;
  double height_mm = 9.4;
  double texture = 1.0;
  double choroid = 1.0;
  VesselTreeOptions vessels;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("um_per_px", self.um_per_px, Range{0.5, 100}, "um",
                  "width of a pixel; source: our choice, finer than any view");
    visitor.field("width_mm", self.width_mm, Range{1, 40}, "mm",
                  "size of the picture; source: HRF photographs, 14.0 x 9.4 mm");
    visitor.field("height_mm", self.height_mm, Range{1, 40}, "mm", "size of the picture; source: our choice");
    visitor.field("texture", self.texture, Range{0, 4}, "",
                  "strength of pigment and nerve fibres; source: HRF, 12 % of green");
    visitor.field("choroid", self.choroid, Range{0, 4}, "",
                  "strength of the choroid's vessels under the retina; source: our choice, by eye");
    visitor.group("vessels", self.vessels);
  }
};

/// Paints a fundus with disc, macula, arteries, veins, choroid, pigment and nerve fibres; the calibre of every vessel
/// is known exactly. The same seed gives the same retina at every `um_per_px`, up to the finest texture.
Fundus proceduralFundus(const ProceduralFundusOptions& options, std::uint64_t seed);

}  // namespace eyeslam::simulation
