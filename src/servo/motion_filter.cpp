// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/motion_filter.h"

namespace eyeslam::servo {

MotionFilter::State MotionFilter::row(const Signals& signals) const noexcept
{
  State row;
  row << 1.0, 0.0, signals;
  return row;
}

void MotionFilter::clearGains() noexcept
{
  state_.tail<kSignals>().setZero();
  covariance_.bottomRows<kSignals>().setZero();
  covariance_.rightCols<kSignals>().setZero();
  covariance_.diagonal().tail<kSignals>().setConstant(start_.gain * start_.gain);
}

void MotionFilter::begin(double measured, double variance, const Signals& signals) noexcept
{
  if (covariance_(0, 0) == 0.0) clearGains();
  jump(measured, variance, signals);
}

void MotionFilter::advance(double time_s, double acceleration, double gain_walk) noexcept
{
  const double t = time_s;
  const double q = acceleration * acceleration;
  state_[0] += t * state_[1];
  covariance_.row(0) += t * covariance_.row(1);
  covariance_.col(0) += t * covariance_.col(1);
  covariance_(0, 0) += q * t * t * t / 3.0;
  covariance_(0, 1) += q * t * t / 2.0;
  covariance_(1, 0) += q * t * t / 2.0;
  covariance_(1, 1) += q * t;
  if (start_.gain > 0.0) covariance_.diagonal().tail<kSignals>().array() += gain_walk * gain_walk * t;
}

double MotionFilter::surprise(double measured, const Signals& signals) const noexcept
{
  return measured - row(signals).dot(state_);
}

double MotionFilter::surpriseVariance(double variance, const Signals& signals) const noexcept
{
  const State seen = row(signals);
  return seen.dot(covariance_ * seen) + variance;
}

void MotionFilter::update(double measured, double variance, const Signals& signals) noexcept
{
  const State seen = covariance_ * row(signals);
  const State gain = seen / surpriseVariance(variance, signals);
  state_ += gain * surprise(measured, signals);
  covariance_ -= gain * seen.transpose();
  // Rounding must not turn it over in a day of operation.
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

void MotionFilter::jump(double measured, double variance, const Signals& signals) noexcept
{
  state_[0] = measured - gains().dot(signals);
  state_[1] = 0.0;
  covariance_.topRows<2>().setZero();
  covariance_.leftCols<2>().setZero();
  covariance_(0, 0) = variance + signals.dot(covariance_.bottomRightCorner<kSignals, kSignals>() * signals);
  covariance_(1, 1) = start_.velocity * start_.velocity;
  // Where gains are off, so is the position, the other way.
  const Signals shared = -(covariance_.bottomRightCorner<kSignals, kSignals>() * signals);
  covariance_.row(0).tail<kSignals>() = shared.transpose();
  covariance_.col(0).tail<kSignals>() = shared;
}

void MotionFilter::foldSignals(const Signals& signals) noexcept
{
  state_[0] += gains().dot(signals);
  covariance_(0, 0) = surpriseVariance(0.0, signals);
  clearGains();
}

double MotionFilter::varianceAfter(double time_s, double acceleration) const noexcept
{
  const double t = time_s;
  return covariance_(0, 0) + 2.0 * t * covariance_(0, 1) + t * t * covariance_(1, 1) +
         acceleration * acceleration * t * t * t / 3.0;
}

}  // namespace eyeslam::servo
