// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/null_predictor.h"

#include <cmath>

#include "eyeslam/retina/units.h"
#include "eyeslam/servo/loop_time.h"

namespace eyeslam::servo {

using retina::Reason;

namespace {

constexpr int kRiccatiSteps = 20000;  // the slowest pole, the drift's, forgets in about 0.1 s: 100 steps
constexpr double kConverged = 1e-13;

// What is measured is the sum of drift and oscillations.
template <class Vector>
Vector measured()
{
  Vector row = Vector::Zero();
  row[0] = 1.0;
  for (Eigen::Index i = 2; i < row.size(); i += 2) row[i] = 1.0;
  return row;
}

// Gain of the filter after so many measurements that it no longer changes. The unit of length is the noise.
template <class Transition, class Vector>
Vector steadyGain(const Transition& step, const Transition& process, double noise)
{
  const Vector row = measured<Vector>();
  Transition covariance = process;
  Vector gain = Vector::Zero();
  for (int i = 0; i < kRiccatiSteps; ++i) {
    covariance = (step * covariance * step.transpose() + process).eval();
    const Vector seen = covariance * row;
    const Vector next = seen / (row.dot(seen) + noise * noise);
    covariance -= next * seen.transpose();
    covariance = (0.5 * (covariance + covariance.transpose())).eval();
    const bool settled = (next - gain).cwiseAbs().maxCoeff() < kConverged * next.cwiseAbs().maxCoeff();
    gain = next;
    if (settled) break;
  }
  return gain;
}

}  // namespace

NullPredictor::NullPredictor(const NullPredictorOptions& options, double period_s)
    : period_s_(period_s),
      damping_(options.damping_per_s),
      longest_gap_(microseconds(options.longest_gap_ms * 1e-3)),
      rates_{kTwoPi * options.low_hz, kTwoPi * options.middle_hz, kTwoPi * options.high_hz},
      step_(transition(period_s)),
      gain_(steadyGain<Transition, Vector>(step_, processNoise(options), options.noise_um * kMicro))
{}

NullPredictor::Transition NullPredictor::transition(double time_s) const
{
  Transition moved = Transition::Identity();
  moved(0, 1) = time_s;
  const double kept = std::exp(-damping_ * time_s);
  for (int i = 0; i < kOscillators; ++i) {
    const double angle = rates_[static_cast<std::size_t>(i)] * time_s;
    const int at = 2 + 2 * i;
    moved(at, at) = moved(at + 1, at + 1) = kept * std::cos(angle);
    moved(at + 1, at) = kept * std::sin(angle);
    moved(at, at + 1) = -moved(at + 1, at);
  }
  return moved;
}

NullPredictor::Transition NullPredictor::processNoise(const NullPredictorOptions& options) const
{
  const double t = period_s_;
  const double drift = options.drift_um_s * kMicro * options.drift_um_s * kMicro;
  Transition noise = Transition::Zero();
  noise.topLeftCorner<2, 2>() << t * t * t / 3.0, t * t / 2.0, t * t / 2.0, t;
  noise.topLeftCorner<2, 2>() *= drift;
  // Forces are what is random, so the noise enters at the velocity: a hand does not leap. (Noise in both of a pair, as
  // in the loop study, makes the filter believe each measured leap: 13.1 instead of 11.5 um at 120 frames a second.)
  // So much comes as the damping takes away: the oscillation keeps its RMS.
  const double size = options.oscillation_um * kMicro;
  const double fresh = size * size * (1.0 - std::exp(-2.0 * damping_ * t));
  for (int i = 3; i < kStates; i += 2) noise(i, i) = 2.0 * fresh;
  return noise;
}

void NullPredictor::start(std::int64_t utime, const Eigen::Vector3d& measured_null) noexcept
{
  state_.setZero();
  state_.row(0) = measured_null.transpose();
  utime_ = utime;
  ready_ = true;
}

Reason NullPredictor::correct(std::int64_t utime, const Eigen::Vector3d& measured_null) noexcept
{
  if (!measured_null.allFinite()) return Reason::state_not_finite;
  if (ready_ && utime <= utime_) return Reason::state_late;
  if (!ready_ || utime - utime_ > longest_gap_) {
    start(utime, measured_null);
    return Reason::none;
  }
  const long periods = std::max(1L, std::lround(seconds(utime - utime_) / period_s_));
  for (long i = 0; i < periods; ++i) state_ = (step_ * state_).eval();
  const Eigen::RowVector3d surprise = measured_null.transpose() - measured<Vector>().transpose() * state_;
  state_ += gain_ * surprise;
  utime_ = utime;
  return Reason::none;
}

Eigen::Vector3d NullPredictor::at(std::int64_t utime) const noexcept
{
  const State moved = transition(seconds(utime - utime_)) * state_;
  return (measured<Vector>().transpose() * moved).transpose();
}

Eigen::Vector3d NullPredictor::velocityAt(std::int64_t utime) const noexcept
{
  const State moved = transition(seconds(utime - utime_)) * state_;
  Eigen::RowVector3d velocity = moved.row(1);
  for (int i = 0; i < kOscillators; ++i) {
    const int at = 2 + 2 * i;
    velocity -= damping_ * moved.row(at) + rates_[static_cast<std::size_t>(i)] * moved.row(at + 1);
  }
  return velocity.transpose();
}

}  // namespace eyeslam::servo
