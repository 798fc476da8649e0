// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/options.h"
#include "eyeslam/servo/laser_interlocks.h"
#include "eyeslam/servo/spot_aim.h"

namespace eyeslam::servo {

struct BurnRunOptions {
  double standoff_um = 1000.0;
  double travel_mm_s = 5.0;
  double travel_m_s2 = 0.2;
  double dwell_ms = 200.0;
  double start_within_ms = 3.0;
  double patience_ms = 300.0;
  double view_margin_um = 100.0;
  double attempts = 3.0;
  double whole_share = 0.95;
  double scale_tolerance = 0.03;
  SpotAimOptions aim;
  LaserInterlocksOptions interlocks;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("standoff_um", self.standoff_um, Range{100, 10000}, "um",
                  "height of the tip above the retina while burning; source: the fibre's divergence, spot of the plan");
    visitor.field("travel_mm_s", self.travel_mm_s, Range{0.1, 20}, "mm/s", "between targets; source: loop study, 1");
    visitor.field("travel_m_s2", self.travel_m_s2, Range{0.1, 10}, "m/s^2",
                  "with which travel begins, half of it to end; source: loop study, 1");
    visitor.field("dwell_ms", self.dwell_ms, Range{0, 5000}, "ms",
                  "at a target, with the pulse at its end; source: loop study, 1");
    visitor.field("start_within_ms", self.start_within_ms, Range{0, 100}, "ms",
                  "a pulse begins so soon after a new pose or waits for the next, 0 = at any time; source: loop study, "
                  "2.8, fewest far pulses");
    visitor.field("patience_ms", self.patience_ms, Range{0, 60000}, "ms",
                  "out of reach or view for so long, a target is left for later; source: below the way to another and "
                  "back, 0.2 to 0.5 s");
    visitor.field("view_margin_um", self.view_margin_um, Range{0, 2000}, "um",
                  "from tip and spot at a target to the picture's border; source: rendered frames, where a spot's rim "
                  "is cut it is not found");
    visitor.field("attempts", self.attempts, Range{1, 100}, "",
                  "a target whose pulse the laser did not begin so often is given up; source: proposal");
    visitor.field("whole_share", self.whole_share, Range{0.5, 1}, "",
                  "share of its duration from which a pulse counts as whole; source: a cycle of the laser in 20 ms");
    visitor.field("scale_tolerance", self.scale_tolerance, Range{0, 0.5}, "",
                  "by which the plan's um per px may differ from the registration's; source: contracts 1, 3 %");
    visitor.group("aim", self.aim);
    visitor.group("interlocks", self.interlocks);
  }
};

}  // namespace eyeslam::servo
