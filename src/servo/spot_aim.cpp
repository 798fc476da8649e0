// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/spot_aim.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::servo {

namespace {

constexpr double kSteepest = 0.25;      // of the beam's unit vector into the retina: 75 deg from the normal
constexpr double kLongestGap_s = 0.02;  // after which the last direction says nothing about this one
constexpr std::int64_t kMean_us = 5000;

}  // namespace

SpotAim::SpotAim(const SpotAimOptions& options) noexcept
    : shaft_s_(1e-3 * options.shaft_ms),
      share_(options.share),
      limit_(1e-6 * options.limit_um),
      gate_(1e-6 * options.gate_um)
{}

void SpotAim::reset() noexcept
{
  spots_.clear();
  correction_.setZero();
}

void SpotAim::observe(std::int64_t utime, const Eigen::Vector3d& tip, const Eigen::Vector3d& shaft) noexcept
{
  if (!tip.allFinite() || !shaft.allFinite() || !(shaft.z() > kSteepest)) return;
  if (!spots_.empty() && utime <= spots_.utime(0)) return;
  const double passed = spots_.empty() ? kLongestGap_s : seconds(utime - spots_.utime(0));
  const double share = passed >= kLongestGap_s ? 1.0 : passed / (passed + shaft_s_);
  const Eigen::Vector2d slope = shaft.head<2>() / shaft.z();
  slope_ += share * (slope - slope_);
  spots_.push(utime, tip.head<2>() - slope_ * tip.z());
}

bool SpotAim::correct(std::int64_t utime, const Eigen::Vector2d& seen) noexcept
{
  if (utime <= seen_utime_ || !seen.allFinite() || !spots_.covers(utime)) return false;
  seen_utime_ = utime;
  const Eigen::Vector2d surprise = seen - spots_.at(utime) - correction_;
  if (!(surprise.norm() <= gate_)) return false;
  correction_ += share_ * surprise;
  correction_ *= std::min(1.0, limit_ / std::max(correction_.norm(), 1e-12));
  return true;
}

Eigen::Vector3d SpotAim::tipFor(const Eigen::Vector2d& place, double standoff) const noexcept
{
  Eigen::Vector3d tip;
  tip << place - correction_ - slope_ * standoff, -standoff;
  return tip;
}

Eigen::Vector2d SpotAim::spot() const noexcept
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  std::size_t count = 0;
  while (count < spots_.size() && spots_.utime(0) - spots_.utime(count) < kMean_us) sum += spots_.value(count++);
  return sum / static_cast<double>(std::max<std::size_t>(count, 1)) + correction_;
}

}  // namespace eyeslam::servo
