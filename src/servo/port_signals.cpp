// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/port_signals.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::servo {

namespace {

constexpr std::int64_t kHoldsFor = 4;  // times the time that the slope was taken over: a line holds no longer

}  // namespace

PortSignals::PortSignals(double fast_s, double slow_s, double slope_s) noexcept
    : fast_s_(fast_s), slow_s_(slow_s), slope_(microseconds(slope_s))
{}

void PortSignals::observe(std::int64_t utime, const Eigen::Vector2d& port) noexcept
{
  if (past_.empty()) {
    origin_ = port;
    past_.push(utime, Signals::Zero());
    return;
  }
  const double passed = seconds(utime - past_.utime(0));
  const Eigen::Vector2d displaced = port - origin_;
  Signals signals = past_.value(0);
  signals.head<2>() += (1.0 - std::exp(-passed / fast_s_)) * (displaced - signals.head<2>());
  signals.tail<2>() += (1.0 - std::exp(-passed / slow_s_)) * (displaced - signals.tail<2>());
  past_.push(utime, signals);
}

PortSignals::Signals PortSignals::at(std::int64_t utime) const noexcept
{
  if (past_.empty()) return Signals::Zero();
  const std::int64_t newest = past_.utime(0);
  if (utime <= newest || past_.size() < 2) return past_.at(utime);
  const std::size_t age = std::min(past_.firstAtOrBefore(newest - slope_), past_.size() - 1);
  const Signals slope = (past_.value(0) - past_.value(age)) / seconds(newest - past_.utime(age));
  return past_.value(0) + seconds(std::min(utime - newest, kHoldsFor * slope_)) * slope;
}

}  // namespace eyeslam::servo
