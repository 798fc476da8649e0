// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/retina/options.h"

namespace eyeslam::robot {

struct VisualServoOptions {
  std::string features = "image";
  std::string servoed = "tip";
  double gain_at_zero_hz = 4.0;
  double gain_at_infinity_hz = 2.0;
  double slope_at_zero = 10.0;
  double standoff_um = 500.0;
  double speed_mm_s = 5.0;
  double least_condition = 0.02;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.choice("features", self.features, {"image", "position"},
                   "in which the error is measured: the image and the height, or the manipulator's frame");
    visitor.choice("servoed", self.servoed, {"tip", "spot"}, "what is brought onto the target");
    visitor.field(
        "gain_at_zero_hz", self.gain_at_zero_hz, Range{0.01, 100}, "1/s",
        "share of a small error that goes in a second (vpAdaptiveGain); with a delay of T s it must stay below "
        "1 / (e T) or the tip overshoots; source: 60 ms of camera and tracking allow 6");
    visitor.field("gain_at_infinity_hz", self.gain_at_infinity_hz, Range{0.01, 100}, "1/s",
                  "of a large error; source: our choice");
    visitor.field("slope_at_zero", self.slope_at_zero, Range{0, 1000}, "1/(s mm)",
                  "by which the gain falls from the one to the other; source: our choice");
    visitor.field("standoff_um", self.standoff_um, Range{0, 20000}, "um",
                  "height of the tip above the retina's plane that is held; source: above touch");
    visitor.field("speed_mm_s", self.speed_mm_s, Range{0.01, 100}, "mm/s",
                  "largest velocity; source: loop study, 1, travel between burns");
    visitor.field(
        "least_condition", self.least_condition, Range{1e-6, 1}, "",
        "smallest to largest effect of a motion of the tip on the features; below, they do not fix it; source: "
        "a camera within 1 degree of the plane");
  }
};

}  // namespace eyeslam::robot
