// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/options.h"
#include "eyeslam/servo/pivot_estimator.h"

namespace eyeslam::robot {

struct RobotMicronOptions {
  double speed_mm_s = 20.0;
  double reach_lateral_mm = 2.0;
  double reach_axial_mm = 2.0;
  double state_limit_ms = 50.0;
  double velocity_limit_ms = 200.0;
  double expiry_ms = 50.0;
  double wait_ms = 2000.0;
  bool keeps_pivot = true;
  servo::PivotEstimatorOptions pivot;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("speed_mm_s", self.speed_mm_s, Range{0.01, 200}, "mm/s",
                  "bound on the tip's goal, whatever setMaxTranslationVelocity says; source: loop study, 2.7");
    visitor.field("reach_lateral_mm", self.reach_lateral_mm, Range{0.01, 10}, "mm",
                  "across the shaft; the controller's own counts where it is smaller; source: facts, B1");
    visitor.field("reach_axial_mm", self.reach_axial_mm, Range{0.01, 10}, "mm",
                  "along the shaft, each way; the controller's own counts where it is smaller; source: facts, B1");
    visitor.field("state_limit_ms", self.state_limit_ms, Range{1, 1000}, "ms",
                  "without a state for longer nothing is commanded; source: contracts, 4");
    visitor.field("velocity_limit_ms", self.velocity_limit_ms, Range{1, 5000}, "ms",
                  "a velocity that is not set again for longer ends; source: six frames of a camera at 30 Hz");
    visitor.field("expiry_ms", self.expiry_ms, Range{1, 1000}, "ms",
                  "of a command, the controller's own counts where it is smaller; source: contracts, 4");
    visitor.field("wait_ms", self.wait_ms, Range{0, 60000}, "ms",
                  "that init() waits for the controller; source: our choice");
    visitor.field("keeps_pivot", self.keeps_pivot, Range{0, 1}, "",
                  "whether the shaft turns about the port; source: facts, B2");
    visitor.group("pivot", self.pivot);
  }
};

}  // namespace eyeslam::robot
