// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "eyeslam/simulation/random.h"

namespace eyeslam::simulation {

/// A second-order section of a digital filter (bilinear transform, corner exact). Passes everything when default-made.
class FilterSection {
 public:
  FilterSection() = default;
  /// Second-order Butterworth; -3 dB at `corner_hz`.
  static FilterSection lowPass(double corner_hz, double period_s);
  /// Gain 1 at `centre_hz`, -3 dB at both ends of a band of `width_hz`.
  static FilterSection bandPass(double centre_hz, double width_hz, double period_s);
  /// One pole with the time constant `time_s`; exact for inputs that are constant within a period.
  static FilterSection lag(double time_s, double period_s);

  double step(double input);
  /// Its state as if `input` had lasted for ever; for filters that pass a constant.
  void hold(double input);

 private:
  double b0_ = 1.0, b1_ = 0.0, b2_ = 0.0, a1_ = 0.0, a2_ = 0.0;
  double first_ = 0.0, second_ = 0.0;
};

/// Up to three sections in a row.
using FilterCascade = std::array<FilterSection, 3>;

double step(FilterCascade& cascade, double input);

/// RMS of a cascade's output, and of its rate of change (1/s), when its input is white noise of unit variance at the
/// sampling rate. `slowest_hz` is the lowest corner or half-width in it.
struct NoiseGain {
  double rms = 0.0;
  double rate_rms = 0.0;
};
NoiseGain noiseGain(FilterCascade cascade, double slowest_hz, double period_s);

/// Gaussian noise of a given spectrum and of unit RMS, stationary from the first sample on. Never allocates.
class ShapedNoise {
 public:
  /// Below `corner_hz`: second-order Butterworth.
  static ShapedNoise lowPass(double corner_hz, double period_s, Random random);
  /// Two band-passes in a row.
  static ShapedNoise bandPass(double centre_hz, double width_hz, double period_s, Random random);

  double step();
  /// RMS of its rate of change, 1/s.
  double rateRms() const { return gain_.rate_rms / gain_.rms; }

 private:
  ShapedNoise(const FilterCascade& cascade, double slowest_hz, double period_s, Random random);

  FilterCascade cascade_;
  NoiseGain gain_;
  Random random_;
};

}  // namespace eyeslam::simulation
