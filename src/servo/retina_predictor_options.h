// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/options.h"

namespace eyeslam::servo {

/// Source, unless said: loop study, sections 2.2 and 2.3.
struct RetinaPredictorOptions {
  double noise_um = 2.0;
  double noise_deg = 0.02;
  double noise_scale = 1e-4;
  double acceleration_um_s2 = 700.0;
  double fast_acceleration_um_s2 = 2000.0;
  double no_port_acceleration_um_s2 = 1500.0;
  double turn_deg_s2 = 3.0;
  double zoom_s2 = 0.02;
  double velocity_mm_s = 0.5;
  double gain = 0.4;
  double gain_walk = 0.02;
  double fast_lag_ms = 40.0;
  double slow_lag_ms = 160.0;
  double slope_ms = 5.0;
  double port_silence_ms = 20.0;
  bool gated = true;
  double gate_um = 25.0;
  double gate_deg = 0.3;
  double gate_sigmas = 4.0;
  double jump_um = 20.0;
  double doubt_ms = 12.0;
  double fade_from_ms = 60.0;
  double fade_ms = 100.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    visitNoise(self, visitor);
    visitPort(self, visitor);
    visitJumps(self, visitor);
  }

 private:
  template <class Self, class Visitor>
  static void visitNoise(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("noise_um", self.noise_um, Range{0.01, 1000}, "um",
                  "RMS per axis of a pose, unless it says more itself");
    visitor.field("noise_deg", self.noise_deg, Range{1e-4, 45}, "deg",
                  "RMS of its angle; source: docs/results, 0.01-0.05");
    visitor.field("noise_scale", self.noise_scale, Range{1e-6, 0.1}, "", "RMS of its scale; source: assumption");
    visitor.field("acceleration_um_s2", self.acceleration_um_s2, Range{0, 1e6}, "um/s^2/sqrt(Hz)",
                  "white acceleration at 30 frames a second");
    visitor.field("fast_acceleration_um_s2", self.fast_acceleration_um_s2, Range{0, 1e6}, "um/s^2/sqrt(Hz)",
                  "the same at 120 frames a second and more, where a jerk spans many frames");
    visitor.field("no_port_acceleration_um_s2", self.no_port_acceleration_um_s2, Range{0, 1e6}, "um/s^2/sqrt(Hz)",
                  "at least so much where the port is not measured");
    visitor.field("turn_deg_s2", self.turn_deg_s2, Range{0, 1e4}, "deg/s^2/sqrt(Hz)",
                  "white angular acceleration; source: rendered sequences, 1 deg within seconds");
    visitor.field("zoom_s2", self.zoom_s2, Range{0, 100}, "1/s^2/sqrt(Hz)",
                  "white acceleration of the scale; source: rendered sequences, 0.06 within 12 s");
    visitor.field("velocity_mm_s", self.velocity_mm_s, Range{0, 100}, "mm/s",
                  "standard deviation of the velocity at first and after a jump, which is over in a moment;"
                  " chosen with eyeslam-bench loop");
  }

  template <class Self, class Visitor>
  static void visitPort(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("gain", self.gain, Range{0, 10}, "",
                  "how far the retina may follow the port, standard deviation; 0: the port is not used");
    visitor.field("gain_walk", self.gain_walk, Range{0, 1}, "per sqrt(s)", "by which that changes");
    visitor.field("fast_lag_ms", self.fast_lag_ms, Range{1, 2000}, "ms", "time constant of the globe, fast part");
    visitor.field("slow_lag_ms", self.slow_lag_ms, Range{1, 2000}, "ms", "time constant of the globe, slow part");
    visitor.field("slope_ms", self.slope_ms, Range{1, 100}, "ms", "over which the port's slope ahead is taken");
    visitor.field("port_silence_ms", self.port_silence_ms, Range{1, 1000}, "ms",
                  "after which a port that is not measured counts as lost; source: assumption");
  }

  template <class Self, class Visitor>
  static void visitJumps(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("gated", self.gated, Range{0, 1}, "", "whether jumps are told from motion");
    visitor.field("gate_um", self.gate_um, Range{0, 5000}, "um", "a surprise beyond this and the sigmas is a jump");
    visitor.field("gate_deg", self.gate_deg, Range{0, 90}, "deg", "the same for the angle; source: assumption");
    visitor.field("gate_sigmas", self.gate_sigmas, Range{0, 20}, "sigma", "the sigmas");
    visitor.field("jump_um", self.jump_um, Range{0, 1000}, "um", "uncertainty of the position after a jump");
    visitor.field("doubt_ms", self.doubt_ms, Range{0, 100}, "ms",
                  "a jump waits for a second frame where frames come faster than this; source: loop study, 3");
    visitor.field("fade_from_ms", self.fade_from_ms, Range{1, 1000}, "ms",
                  "age of a frame from which the velocity fades");
    visitor.field("fade_ms", self.fade_ms, Range{1, 5000}, "ms", "time constant of the fading");
  }
};

}  // namespace eyeslam::servo
