// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/options.h"
#include "eyeslam/simulation/micron_options.h"

namespace eyeslam::simulation {

/// The controller's own tremor filter: what is slower than its corner passes, a part of what is faster.
struct ShelvingFilterOptions {
  double corner_hz = 1.5;
  double passed = 0.1;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("corner_hz", self.corner_hz, Range{0.05, 50}, "Hz",
                  "of two equal poles; source: loop study, 2.5; the instrument's own is not published, facts, B2, I2");
    visitor.field("passed", self.passed, Range{0, 1}, "of the hand's motion",
                  "that remains far above the corner; source: facts, B1, 90 % cut in pointing");
  }
};

struct PivotKeeperOptions {
  double shaft_mm = 20.0;
  double tilt_deg = 8.0;
  double tolerance_um = 100.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field(
        "shaft_mm", self.shaft_mm, Range{5, 100}, "mm",
        "from the tip to where the shaft is held while no pivot is commanded; source: facts, B1, RCM near the "
        "middle of the shaft");
    visitor.field("tilt_deg", self.tilt_deg, Range{0.1, 45}, "deg",
                  "largest angle between shaft and handle; source: assumption, 2.8 mm at 20 mm");
    visitor.field("tolerance_um", self.tolerance_um, Range{1, 5000}, "um",
                  "a shaft farther from its pivot does not keep it; source: issue, within 100 um");
  }
};

struct MicronControllerOptions {
  MicronOptions plant;
  ShelvingFilterOptions filter;
  PivotKeeperOptions pivot;
  double expiry_ms = 50.0;
  double ramp_ms = 150.0;
  double own_speed_mm_s = 20.0;
  double calm_ms = 2.0;
  double handle_mm = 60.0;
  bool port_measured = true;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.group("plant", self.plant);
    visitor.group("filter", self.filter);
    visitor.group("pivot", self.pivot);
    visitor.field("expiry_ms", self.expiry_ms, Range{1, 1000}, "ms",
                  "after sending, a command is not followed for longer, whatever it says; source: contracts, 4");
    visitor.field("ramp_ms", self.ramp_ms, Range{0, 2000}, "ms",
                  "from one way of choosing the goal to another; source: issue, 100-200 ms");
    visitor.field("own_speed_mm_s", self.own_speed_mm_s, Range{0.1, 200}, "mm/s",
                  "largest speed of the tip that no command bounds; source: loop study, 2.7");
    visitor.field(
        "calm_ms", self.calm_ms, Range{0, 100}, "ms",
        "time constant over which the hand's speed is measured, to bound the tip's; source: our choice, 3 um of "
        "noise then is near 1 mm/s");
    visitor.field("handle_mm", self.handle_mm, Range{1, 500}, "mm",
                  "from the tip to the handle's origin; source: facts, B1, base and height of the manipulator, and a "
                  "needle");
    visitor.field("port_measured", self.port_measured, Range{0, 1}, "",
                  "whether the state tells the port's displacement; source: loop study, 3, both are tested");
  }
};

}  // namespace eyeslam::simulation
