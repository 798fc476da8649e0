// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "eyeslam/retina/options.h"

namespace eyeslam::configuration {

struct LensOptions {
  double focus_mm = 12.5;
  int turns = 3;
  bool coated = true;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("focus_mm", self.focus_mm, Range{1.0, 100.0}, "mm", "how far it sees; source: the maker");
    visitor.field("turns", self.turns, Range{0, 10}, "", "of the ring; source: counted");
    visitor.field("coated", self.coated, Range{}, "", "against glare | haze; source: the maker");
  }
};

struct CameraOptions {
  std::string kind = "colour";
  LensOptions lens;
  double gain = 0.1;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    visitor.choice("kind", self.kind, {"colour", "grey"}, "of picture; source: the buyer");
    visitor.group("lens", self.lens);
    visitor.field("gain", self.gain, retina::Range{}, "dB", "of the sensor; source: the maker");
  }
};

}  // namespace eyeslam::configuration
