// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace eyeslam::servo {

/// A Kalman filter for one coordinate that is seen now and then: position, velocity (white acceleration), and how far
/// it follows four signals that are known at any time: measured = position + gains . signals. SI. Never allocates.
class MotionFilter {
 public:
  static constexpr int kSignals = 4;
  using Signals = Eigen::Matrix<double, kSignals, 1>;

  struct Start {
    double velocity = 0.0;  ///< standard deviation at first, and after a jump
    double gain = 0.0;      ///< of each gain about 0; 0: the signals are not used
  };

  explicit MotionFilter(const Start& start) noexcept : start_(start) {}

  /// The first measurement; gains keep what they have learnt.
  void begin(double measured, double variance, const Signals& signals) noexcept;
  /// @param acceleration  white, unit/s^2/sqrt(Hz); @param gain_walk  per sqrt(s)
  void advance(double time_s, double acceleration, double gain_walk) noexcept;
  /// Measured minus expected, and its variance.
  double surprise(double measured, const Signals& signals) const noexcept;
  double surpriseVariance(double variance, const Signals& signals) const noexcept;
  void update(double measured, double variance, const Signals& signals) noexcept;
  /// The position becomes what is measured, the velocity 0; gains stay.
  void jump(double measured, double variance, const Signals& signals) noexcept;
  /// Gains and what they did vanish into the position: the signals are lost.
  void foldSignals(const Signals& signals) noexcept;

  double position() const noexcept { return state_[0]; }
  double velocity() const noexcept { return state_[1]; }
  Signals gains() const noexcept { return state_.tail<kSignals>(); }
  /// Variance of the position `time_s` later, signals known.
  double varianceAfter(double time_s, double acceleration) const noexcept;

 private:
  static constexpr int kStates = 2 + kSignals;
  using State = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  State row(const Signals& signals) const noexcept;
  void clearGains() noexcept;

  Start start_;
  State state_ = State::Zero();
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace eyeslam::servo
