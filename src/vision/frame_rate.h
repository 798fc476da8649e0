// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace eyeslam::vision {

/// How often a live source's frames come: the tracker's velocity is one per frame that it was given, and a live source
/// leaves frames out.
class FrameRate {
 public:
  /// @param nominal  1/s, until frames tell
  explicit FrameRate(double nominal) : rate_(nominal), period_us_(kMicroseconds / nominal) {}

  /// @param utime  of the next frame, us since 1970; 0 where it bears no time of its own
  /// @return 1/s
  double follow(std::int64_t utime)
  {
    if (utime > last_utime_ && last_utime_ > 0) {
      period_us_ += kShare * (static_cast<double>(utime - last_utime_) - period_us_);
      rate_ = kMicroseconds / period_us_;
    }
    last_utime_ = utime;
    return rate_;
  }

 private:
  static constexpr double kMicroseconds = 1e6;  // a second
  static constexpr double kShare = 0.2;         // of the newest: as long a memory as the tracker's filter has

  std::int64_t last_utime_ = 0;
  double rate_;  // 1/s
  double period_us_;
};

}  // namespace eyeslam::vision
