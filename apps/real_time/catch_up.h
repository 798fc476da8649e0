// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

#include "real_time/real_time_loop.h"

namespace eyeslam::apps {

/// Lets a simulated world go on by as many milliseconds as have passed, whoever was late.
class CatchUp {
 public:
  /// Of a loop whose period is a millisecond, each cycle.
  /// @param step  of the world: step(monotonic, utime), us as in CycleStart
  template <class Step>
  void run(const CycleStart& start, const Step& step)
  {
    const std::int64_t passed = std::min(1 + start.left_out - left_out_, kMostAtOnce);
    left_out_ = start.left_out;
    for (std::int64_t i = passed - 1; i >= 0; --i) step(start.monotonic - i * kPeriod_us, start.utime - i * kPeriod_us);
  }

 private:
  static constexpr std::int64_t kPeriod_us = 1000;
  static constexpr std::int64_t kMostAtOnce = 200;  // milliseconds; a longer pause is one of the world

  std::int64_t left_out_ = 0;
};

}  // namespace eyeslam::apps
