// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/integral_action.h"

#include <algorithm>

#include "eyeslam/retina/units.h"

namespace eyeslam::servo {

namespace {

constexpr double kLongestStep_s = 5e-3;  // after a longer gap the error says little about the time between

}  // namespace

IntegralAction::IntegralAction(const IntegralActionOptions& options) noexcept
    : rate_(options.rate_per_s), freeze_(options.freeze_um * kMicro), limit_(options.limit_um * kMicro)
{}

void IntegralAction::update(const Eigen::Vector3d& error, double time_s) noexcept
{
  const double size = error.norm();
  // Written so that NaN, in either, fails the test.
  if (!(size <= freeze_) || !(time_s > 0.0)) return;
  correction_ += rate_ * std::min(time_s, kLongestStep_s) * error;
  const double length = correction_.norm();
  if (length > limit_) correction_ *= limit_ / length;
}

}  // namespace eyeslam::servo
