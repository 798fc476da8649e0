// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "eyeslam/servo/motion_filter.h"
#include "eyeslam/servo/timed_ring.h"

namespace eyeslam::servo {

/// The port's displacement as the globe may follow it: two axes through two low-passes each, known for the last half
/// second and a few milliseconds ahead. Source: loop study, section 2.2. Never allocates.
class PortSignals {
 public:
  using Signals = MotionFilter::Signals;  ///< x, y through the fast low-pass, then through the slow one; m

  PortSignals(double fast_s, double slow_s, double slope_s) noexcept;

  /// One measured displacement; m, in any frame that stays. Times rise. The first is the origin.
  void observe(std::int64_t utime, const Eigen::Vector2d& port) noexcept;
  void clear() noexcept { past_.clear(); }

  bool inUse() const noexcept { return !past_.empty(); }
  std::int64_t utime() const noexcept { return past_.empty() ? 0 : past_.utime(0); }
  /// Beyond the newest: along the slope of the last milliseconds. Zero when nothing was observed.
  Signals at(std::int64_t utime) const noexcept;

 private:
  double fast_s_, slow_s_;
  std::int64_t slope_;  // us
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  TimedRing<Signals, 512> past_;
};

}  // namespace eyeslam::servo
