// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/options.h"

namespace eyeslam::simulation {

/// Source, unless said: loop study, section 1 (assumptions: the instrument's own figures are not published).
struct MicronOptions {
  double delay_ms = 2.0;
  double bandwidth_hz = 80.0;
  double damping = 0.7;
  double speed_mm_s = 30.0;
  double acceleration_m_s2 = 10.0;
  double reach_mm = 2.0;
  double reach_axial_mm = 2.0;
  double gain_error = 0.03;
  double bend_um = 6.0;
  double bend_hz = 1.0;
  double noise_um = 3.0;
  double state_age_ms = 1.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("delay_ms", self.delay_ms, Range{0, 30}, "ms",
                  "from a command to the middle of its effect, which is held for a period");
    visitor.field("bandwidth_hz", self.bandwidth_hz, Range{1, 1000}, "Hz", "natural frequency of the actuators");
    visitor.field("damping", self.damping, Range{0.1, 5}, "", "of the actuators");
    visitor.field("speed_mm_s", self.speed_mm_s, Range{0.1, 1000}, "mm/s", "largest speed of the deflection");
    visitor.field("acceleration_m_s2", self.acceleration_m_s2, Range{0.1, 1000}, "m/s^2", "largest acceleration");
    visitor.field("reach_mm", self.reach_mm, Range{0.05, 10}, "mm",
                  "largest deflection, across the shaft where that is known; source: facts, B1");
    visitor.field("reach_axial_mm", self.reach_axial_mm, Range{0.05, 10}, "mm",
                  "largest deflection along the shaft, where that is known; source: facts, B1, cylinder 4 x 4 mm");
    visitor.field("gain_error", self.gain_error, Range{0, 0.5}, "",
                  "by which each axis moves too far or too little, the sign drawn");
    visitor.field("bend_um", self.bend_um, Range{0, 500}, "um", "RMS per axis of the needle's bending, unmeasured");
    visitor.field("bend_hz", self.bend_hz, Range{0.01, 50}, "Hz", "highest frequency of the bending");
    visitor.field("noise_um", self.noise_um, Range{0, 500}, "um",
                  "white RMS per axis of measured null, tip and port; source: facts, B1");
    visitor.field("state_age_ms", self.state_age_ms, Range{0, 14}, "ms",
                  "of what it measured, when a servo hears of it");
  }
};

}  // namespace eyeslam::simulation
