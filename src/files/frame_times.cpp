// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/frame_times.h"

#include <cmath>

namespace eyeslam::files {

namespace {
constexpr double kUsualRate = 30.0;
}

FrameTimes::FrameTimes(double frames_per_second)
    : period_(1.0 / (std::isfinite(frames_per_second) && frames_per_second > 0.0 ? frames_per_second : kUsualRate))
{}

double FrameTimes::next(double position_ms)
{
  const double position = position_ms / 1000.0;
  if (count_++ == 0) {
    first_ = std::isfinite(position) ? position : 0.0;
    return 0.0;
  }
  const double time = position - first_;
  const bool later = std::isfinite(time) && time > last_;
  if (!later) ++repaired_;
  last_ = later ? time : last_ + period_;
  return last_;
}

}  // namespace eyeslam::files
