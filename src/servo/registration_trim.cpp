// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/registration_trim.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"
#include "eyeslam/servo/square.h"

namespace eyeslam::servo {

using retina::Reason;

namespace {

constexpr double kLever = 1e-3;           // m: makes all six corrections lengths of one size
constexpr double kLargestMatrix = 0.2;    // beyond it the registration is wrong, not off: the inverse stays safe
constexpr double kLongestPause_s = 60.0;  // a longer one adds no more doubt

}  // namespace

RegistrationTrim::RegistrationTrim(const RegistrationTrimOptions& options, const Eigen::Vector2d& centre)
    : options_(options), centre_(centre), covariance_(Eigen::Matrix3d::Zero())
{
  reopen();
}

void RegistrationTrim::reopen() noexcept
{
  const double matrix = square(options_.matrix * kLever);
  covariance_.setZero();
  covariance_.diagonal() << square(options_.offset_um * kMicro), matrix, matrix;
  refused_in_a_row_ = 0;
}

Reason RegistrationTrim::observe(std::int64_t utime, const Eigen::Vector2d& measured) noexcept
{
  if (!measured.allFinite()) return Reason::state_not_finite;
  if (!measured_.empty() && utime <= measured_.utime(0)) return Reason::state_late;
  measured_.push(utime, measured);
  return Reason::none;
}

RegistrationTrim::Row RegistrationTrim::row(const Eigen::Vector2d& seen) const noexcept
{
  const Eigen::Vector2d place = (seen - centre_) / kLever;
  return {1.0, place.x(), place.y()};
}

// The mean of what was measured while the shutter was open; of the two nearest when nothing was.
bool RegistrationTrim::meanOver(const SeenTip& seen, Eigen::Vector2d& mean) const noexcept
{
  const std::int64_t half = microseconds(0.5 * seen.exposure_s);
  if (!measured_.covers(seen.utime - half) || !measured_.covers(seen.utime + half)) return false;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (std::size_t age = measured_.firstAtOrBefore(seen.utime + half);
       age < measured_.size() && measured_.utime(age) >= seen.utime - half; ++age) {
    sum += measured_.value(age);
    count += 1.0;
  }
  mean = count > 0.0 ? Eigen::Vector2d(sum / count) : measured_.at(seen.utime);
  return true;
}

void RegistrationTrim::advance(std::int64_t utime) noexcept
{
  const double passed = utime_ == 0 ? 0.0 : std::min(seconds(utime - utime_), kLongestPause_s);
  covariance_(0, 0) += options_.offset_walk_um2_s * kMicro * kMicro * passed;
  covariance_(1, 1) += square(options_.matrix_walk * kLever) * passed;
  covariance_(2, 2) += square(options_.matrix_walk * kLever) * passed;
  utime_ = utime;
}

Reason RegistrationTrim::correct(const SeenTip& seen) noexcept
{
  if (!seen.view.allFinite() || !std::isfinite(seen.sigma) || !std::isfinite(seen.exposure_s))
    return Reason::tip_not_finite;
  Eigen::Vector2d measured;
  if ((utime_ != 0 && seen.utime <= utime_) || !meanOver(seen, measured)) return Reason::tip_late;
  advance(seen.utime);
  const Row place = row(seen.view);
  const double noise = square(std::max(seen.sigma, options_.seen_um * kMicro)) + square(options_.measured_um * kMicro);
  const double variance = place.dot(covariance_ * place) + noise;
  const Eigen::RowVector2d surprise = (measured - seen.view).transpose() - place.transpose() * corrections_;
  if (surprise.norm() > options_.gate_sigmas * std::sqrt(variance) + options_.gate_um * kMicro) {
    if (++refused_in_a_row_ >= options_.reopen_frames) reopen();
    return Reason::tip_far;
  }
  refused_in_a_row_ = 0;
  const Row gain = covariance_ * place / variance;
  corrections_ += gain * surprise;
  covariance_ -= gain * (place.transpose() * covariance_).eval();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  keepSolution();
  return Reason::none;
}

void RegistrationTrim::rebase(const Eigen::Affine2d& new_T_old) noexcept
{
  const Eigen::Vector2d offset = new_T_old * centre_ - centre_ + new_T_old.linear() * offset_;
  const Eigen::Matrix2d linear = new_T_old.linear() * linear_;
  corrections_.row(0) = offset.transpose();
  corrections_.bottomRows<2>() = kLever * (linear - Eigen::Matrix2d::Identity()).transpose();
  measured_.transform([&new_T_old](const Eigen::Vector2d& old) -> Eigen::Vector2d { return new_T_old * old; });
  keepSolution();
}

void RegistrationTrim::keepSolution() noexcept
{
  offset_ = corrections_.row(0).transpose();
  const Eigen::Matrix2d matrix = corrections_.bottomRows<2>().transpose() / kLever;
  linear_ = Eigen::Matrix2d::Identity() + matrix.cwiseMax(-kLargestMatrix).cwiseMin(kLargestMatrix);
  inverse_ << linear_(1, 1), -linear_(0, 1), -linear_(1, 0), linear_(0, 0);
  inverse_ /= linear_(0, 0) * linear_(1, 1) - linear_(0, 1) * linear_(1, 0);
}

Eigen::Vector2d RegistrationTrim::toMeasured(const Eigen::Vector2d& seen) const noexcept
{
  return centre_ + offset_ + linear_ * (seen - centre_);
}

Eigen::Vector2d RegistrationTrim::toSeen(const Eigen::Vector2d& measured) const noexcept
{
  return centre_ + inverse_ * (measured - centre_ - offset_);
}

double RegistrationTrim::sigmaAt(const Eigen::Vector2d& seen) const noexcept
{
  const Row place = row(seen);
  return std::sqrt(place.dot(covariance_ * place));
}

}  // namespace eyeslam::servo
