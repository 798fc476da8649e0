// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/retina/options.h"

namespace eyeslam::simulation {

/// How the retina moves while an instrument is in the eye. The defaults are an eye in situ. Pairs (low, high) are drawn
/// once per seed. Source, unless said: loop study, section 1.
struct RetinaMotionOptions {
  double speed_low_mm_s = 0.3;
  double speed_high_mm_s = 0.8;
  double hand_share = 0.7;
  double unseen_hz = 0.6;
  double port_hz = 0.75;
  double port_tremor = 0.3;
  double port_travel = 0.1;
  double port_gain = 0.45;
  double port_gain_spread = 0.3;
  double port_turn_deg = 20.0;
  double port_wander = 0.12;
  double port_wander_s = 10.0;
  double port_lag_ms = 40.0;
  double breath_hz = 0.25;
  double breath_low_um = 40.0;
  double breath_high_um = 120.0;
  double breath_axial_um = 60.0;
  double pulse_low_um = 8.0;
  double pulse_high_um = 20.0;
  double pulse_axial_um = 9.0;
  double axial_noise_um = 5.0;
  double rotation_deg = 0.5;
  double jerks_per_s = 0.0;
  double jerk_shortest_mm = 0.2;
  double jerk_longest_mm = 0.6;
  double jerk_ms = 100.0;
  double jerk_rotation_deg = 0.4;
  double tool_jerk_share = 0.0;
  double reach_mm = 1.5;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    visitSmooth(self, visitor);
    visitPort(self, visitor);
    visitCycles(self, visitor);
    visitJerks(self, visitor);
  }

 private:
  template <class Self, class Visitor>
  static void visitSmooth(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("speed_low_mm_s", self.speed_low_mm_s, Range{0, 20}, "mm/s",
                  "smallest RMS speed of the smooth motion");
    visitor.field("speed_high_mm_s", self.speed_high_mm_s, Range{0, 20}, "mm/s",
                  "largest RMS speed of the smooth motion");
    visitor.field("hand_share", self.hand_share, Range{0, 1}, "of the smooth motion's squared speed",
                  "what the instrument does through its port; 0 on paper");
    visitor.field("unseen_hz", self.unseen_hz, Range{0.01, 5}, "Hz", "highest frequency of what no sensor sees");
    visitor.field("rotation_deg", self.rotation_deg, Range{0, 20}, "deg",
                  "RMS of the slow turn about the line of sight; source: rendered sequences, 1 deg of amplitude");
  }

  template <class Self, class Visitor>
  static void visitPort(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("port_hz", self.port_hz, Range{0.01, 5}, "Hz", "highest frequency of the port's own displacement");
    visitor.field("port_tremor", self.port_tremor, Range{0, 1}, "of the tremor", "that reaches the port");
    visitor.field("port_travel", self.port_travel, Range{0, 1}, "of the hand's travel", "that reaches the port");
    visitor.field("port_gain", self.port_gain, Range{0, 2}, "", "how far the retina follows the port, the other way");
    visitor.field("port_gain_spread", self.port_gain_spread, Range{0, 0.99}, "of the gain",
                  "largest deviation of an eye");
    visitor.field("port_turn_deg", self.port_turn_deg, Range{0, 180}, "deg",
                  "largest angle between the port's displacement and what the retina makes of it");
    visitor.field("port_wander", self.port_wander, Range{0, 1}, "of the gain, and rad of the turn",
                  "RMS by which both wander");
    visitor.field("port_wander_s", self.port_wander_s, Range{0.1, 1000}, "s", "time constant of the wandering");
    visitor.field("port_lag_ms", self.port_lag_ms, Range{1, 1000}, "ms",
                  "time constant of each of the globe's two poles");
  }

  template <class Self, class Visitor>
  static void visitCycles(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("breath_hz", self.breath_hz, Range{0.05, 1}, "Hz", "breathing, within a tenth; source: facts, C5");
    visitor.field("breath_low_um", self.breath_low_um, Range{0, 2000}, "um",
                  "smallest peak of breathing across the view");
    visitor.field("breath_high_um", self.breath_high_um, Range{0, 2000}, "um",
                  "largest peak of breathing across the view");
    visitor.field("breath_axial_um", self.breath_axial_um, Range{0, 2000}, "um",
                  "peak of breathing along the line of sight");
    visitor.field("pulse_low_um", self.pulse_low_um, Range{0, 500}, "um", "smallest peak of the pulse across the view");
    visitor.field("pulse_high_um", self.pulse_high_um, Range{0, 500}, "um",
                  "largest peak of the pulse across the view");
    visitor.field("pulse_axial_um", self.pulse_axial_um, Range{0, 500}, "um",
                  "peak of the pulse along the line of sight");
    visitor.field("axial_noise_um", self.axial_noise_um, Range{0, 500}, "um",
                  "RMS of the rest of the axial motion, below 5 Hz");
  }

  template <class Self, class Visitor>
  static void visitJerks(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("jerks_per_s", self.jerks_per_s, Range{0, 5}, "1/s", "mean rate of jerks; 0.4 jerky, 0.3 saccades");
    visitor.field("jerk_shortest_mm", self.jerk_shortest_mm, Range{0, 10}, "mm",
                  "smallest jerk; 0.2 jerky, 0.5 saccades");
    visitor.field("jerk_longest_mm", self.jerk_longest_mm, Range{0, 10}, "mm", "largest jerk; 0.6 jerky, 1.3 saccades");
    visitor.field("jerk_ms", self.jerk_ms, Range{2, 2000}, "ms", "how long a jerk lasts; 100 jerky, 40 saccades");
    visitor.field("jerk_rotation_deg", self.jerk_rotation_deg, Range{0, 20}, "deg",
                  "largest turn of a jerk; source: rendered sequences");
    visitor.field("tool_jerk_share", self.tool_jerk_share, Range{0, 1}, "of the jerks",
                  "that the instrument causes: they reach the eye through the port and its lag; source: loop study, 3");
    visitor.field("reach_mm", self.reach_mm, Range{0.1, 20}, "mm",
                  "jerks beyond this distance from the start go back; source: rendered sequences, 160 px");
  }
};

/// The motions that a scenario knows (contracts, section 7): paper, in_situ, jerky, saccade.
const std::vector<const char*>& retinaMotionNames();
/// @throws std::invalid_argument naming the word and those known
RetinaMotionOptions retinaMotionOptions(const std::string& name);

}  // namespace eyeslam::simulation
