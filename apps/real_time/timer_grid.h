// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace eyeslam::apps {

/// When the cycles of a loop are due: start, start + period, ... A late cycle moves none of those after it; those whose
/// time passed while it was late are left out and counted, never caught up. No clock. Times in ns of a monotonic one.
class TimerGrid {
 public:
  /// A cycle that starts.
  struct Start {
    double lateness = 0.0;      ///< s after it was due, >= 0
    std::int64_t left_out = 0;  ///< cycles that were due meanwhile
  };

  TimerGrid(std::int64_t first_ns, std::int64_t period_ns) : due_(first_ns), period_(period_ns) {}

  /// When the next cycle is due.
  std::int64_t due() const { return due_; }

  /// The next cycle starts. @param now  not before due(), or it counts as on time
  Start start(std::int64_t now)
  {
    const std::int64_t late = now > due_ ? now - due_ : 0;
    const std::int64_t left_out = late / period_;
    due_ += (1 + left_out) * period_;
    return {1e-9 * static_cast<double>(late), left_out};
  }

 private:
  std::int64_t due_;
  std::int64_t period_;
};

}  // namespace eyeslam::apps
