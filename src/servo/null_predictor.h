// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::servo {

struct NullPredictorOptions {
  double noise_um = 3.0;
  double drift_um_s = 1800.0;
  double low_hz = 7.5;
  double middle_hz = 10.0;
  double high_hz = 13.0;
  double damping_per_s = 4.0;
  double oscillation_um = 80.0;
  double longest_gap_ms = 50.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("noise_um", self.noise_um, Range{0.01, 1000}, "um",
                  "RMS per axis of a measured null; source: facts, B1");
    visitor.field("drift_um_s", self.drift_um_s, Range{0, 1e6}, "um/s in a second",
                  "random walk of the hand's velocity; source: loop study, 2.1");
    visitor.field("low_hz", self.low_hz, Range{0.5, 50}, "Hz", "slowest of three oscillators; source: loop study, 2.1");
    visitor.field("middle_hz", self.middle_hz, Range{0.5, 50}, "Hz", "middle oscillator; source: loop study, 2.1");
    visitor.field("high_hz", self.high_hz, Range{0.5, 50}, "Hz", "fastest oscillator; source: loop study, 2.1");
    visitor.field("damping_per_s", self.damping_per_s, Range{0.01, 200}, "1/s",
                  "how fast an oscillation is forgotten; source: loop study, 2.1");
    visitor.field(
        "oscillation_um", self.oscillation_um, Range{0, 5000}, "um",
        "RMS of each oscillator per axis; source: tremor of 50-100 um, loop study, 1; chosen with eyeslam-bench loop");
    visitor.field("longest_gap_ms", self.longest_gap_ms, Range{1, 1000}, "ms",
                  "after a longer silence it starts anew; source: contracts, 4, Hold without a state");
  }
};

/// Where the hand will carry the manipulator's null a few milliseconds from now, tremor included: per axis a
/// steady-state Kalman filter with a drift (position, velocity) and three damped oscillators.
///
///   NullPredictor hand({});
///   each cycle: hand.correct(state.utime, state.null);
///               deflection = goal - hand.at(now + lead);
///
/// Metres, in the frame of what is measured. Source: loop study, section 2.1. Never throws, never allocates.
class NullPredictor {
 public:
  /// @param period_s  of the states, which come at a steady rate
  explicit NullPredictor(const NullPredictorOptions& options, double period_s = 1e-3);

  /// Takes one measured null. A missed period or two are bridged.
  /// @return none; state_late, state_not_finite: refused, nothing changed
  retina::Reason correct(std::int64_t utime, const Eigen::Vector3d& measured) noexcept;

  /// The null expected at an instant, m; of the newest state's or later. Zero before the first state.
  Eigen::Vector3d at(std::int64_t utime) const noexcept;
  /// Its velocity then, m/s.
  Eigen::Vector3d velocityAt(std::int64_t utime) const noexcept;

  bool isReady() const noexcept { return ready_; }
  std::int64_t utime() const noexcept { return utime_; }

 private:
  static constexpr int kOscillators = 3;
  static constexpr int kStates = 2 + 2 * kOscillators;  // position, velocity, then a turning pair per oscillator
  using Transition = Eigen::Matrix<double, kStates, kStates>;
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using State = Eigen::Matrix<double, kStates, 3>;  // a column per axis

  Transition transition(double time_s) const;
  Transition processNoise(const NullPredictorOptions& options) const;
  void start(std::int64_t utime, const Eigen::Vector3d& measured) noexcept;

  double period_s_, damping_;
  std::int64_t longest_gap_;                // us
  std::array<double, kOscillators> rates_;  // rad/s
  Transition step_;
  Vector gain_;
  State state_ = State::Zero();
  std::int64_t utime_ = 0;
  bool ready_ = false;
};

}  // namespace eyeslam::servo
