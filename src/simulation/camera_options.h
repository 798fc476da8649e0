// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/retina/options.h"

namespace eyeslam::simulation {

/// When a camera's poses come. The defaults are "30/20": 30 frames a second, at most 20 ms from mid-exposure to pose.
struct CameraTimingOptions {
  double rate_hz = 30.0;
  double exposure_ms = 8.0;
  double latency_low_ms = 14.0;
  double latency_high_ms = 20.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("rate_hz", self.rate_hz, Range{1, 1000}, "Hz", "frames a second; source: loop study, 1");
    visitor.field("exposure_ms", self.exposure_ms, Range{0, 100}, "ms", "source: loop study, 1");
    visitor.field("latency_low_ms", self.latency_low_ms, Range{0, 500}, "ms",
                  "shortest time from mid-exposure to the pose; source: loop study, 1");
    visitor.field("latency_high_ms", self.latency_high_ms, Range{0, 500}, "ms", "longest; source: loop study, 1");
  }
};

/// How a tracker errs. Source, unless said: loop study, section 1 (assumptions).
struct TrackerModelOptions {
  double noise_um = 2.0;
  double bias_um = 1.0;
  double bias_s = 5.0;
  double turn_noise_deg = 0.02;
  double blur_share = 0.05;
  double fast_mm_s = 12.0;
  double fast_refused = 0.8;
  double outliers = 0.005;
  double unflagged = 0.1;
  double outlier_low_um = 100.0;
  double outlier_high_um = 400.0;
  double tip_noise_um = 5.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("noise_um", self.noise_um, Range{0, 1000}, "um", "RMS per axis; 0.2 px at half size");
    visitor.field("bias_um", self.bias_um, Range{0, 1000}, "um", "RMS per axis of an error that lasts");
    visitor.field("bias_s", self.bias_s, Range{0.01, 1000}, "s", "how long it lasts; source: assumption");
    visitor.field("turn_noise_deg", self.turn_noise_deg, Range{0, 45}, "deg", "RMS; source: docs/results, 0.01-0.05");
    visitor.field("blur_share", self.blur_share, Range{0, 1}, "of the way during an exposure", "RMS error along it");
    visitor.field("fast_mm_s", self.fast_mm_s, Range{0, 1000}, "mm/s", "faster frames are mostly refused");
    visitor.field("fast_refused", self.fast_refused, Range{0, 1}, "", "share of these");
    visitor.field("outliers", self.outliers, Range{0, 1}, "of the frames", "whose pose is wrong");
    visitor.field("unflagged", self.unflagged, Range{0, 1}, "of the outliers", "that the tracker does not notice");
    visitor.field("outlier_low_um", self.outlier_low_um, Range{0, 1e4}, "um", "smallest error of an outlier");
    visitor.field("outlier_high_um", self.outlier_high_um, Range{0, 1e4}, "um", "largest error of an outlier");
    visitor.field("tip_noise_um", self.tip_noise_um, Range{0, 1000}, "um",
                  "RMS per axis of the tip that is seen; 1 px");
  }
};

/// How wrong the registration of camera and manipulator is. Source: loop study, section 1 (assumptions).
struct RegistrationErrorOptions {
  double scale = 0.02;
  double rotation_deg = 1.0;
  double drift_um = 15.0;
  double drift_s = 10.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("scale", self.scale, Range{0, 0.5}, "", "by which lengths are wrong, the sign drawn");
    visitor.field("rotation_deg", self.rotation_deg, Range{0, 45}, "deg", "by which it is turned, the sign drawn");
    visitor.field("drift_um", self.drift_um, Range{0, 1000}, "um", "RMS per axis by which the picture wanders");
    visitor.field("drift_s", self.drift_s, Range{0.01, 1000}, "s", "time constant of the wandering");
  }
};

}  // namespace eyeslam::simulation
