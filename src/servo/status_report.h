// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/servo/servo_ears.h"

namespace eyeslam::servo {

/// How the program ran the last cycle; s. Zeros in lock step, where no measured duration may enter a message.
struct CycleTiming {
  double lateness_s = 0.0;     ///< start of this cycle after the time it was due
  double computation_s = 0.0;  ///< CPU time of the cycle before this one
  std::int64_t overruns = 0;   ///< cycles left out, since the start
  bool real_time = false;      ///< scheduled in real time with its memory locked
};

/// Gathers SERVO_STATUS and says when it is due: at a steady rate, and at once when state or reason change.
class StatusReport {
 public:
  /// @param period  us
  explicit StatusReport(std::int64_t period) : period_(period) {}

  /// The counts and ages of a cycle. @param monotonic  us, now
  void gather(const ServoEars& ears, const CycleTiming& timing, std::int64_t monotonic) noexcept;
  void setState(messaging::ServoState state, retina::Reason reason) noexcept;
  /// The pose in use. @param age_s  since mid-exposure; negative: none yet
  void setPose(std::int64_t map_id, double age_s) noexcept;
  void setFrameToCommand(double time_s) noexcept { status_.frame_to_command = time_s; }

  /// Whether it is to be published in this cycle; if so, the largest values begin anew in the next one.
  bool isDue(std::int64_t monotonic) noexcept;
  const messaging::ServoStatus& status() const noexcept { return status_; }

 private:
  std::int64_t period_;
  messaging::ServoStatus status_;
  bool changed_ = true;
  bool published_ = false;
  std::int64_t last_ = 0;
};

}  // namespace eyeslam::servo
