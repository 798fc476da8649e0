// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/servo/servo.h"

namespace eyeslam::servo {

/// When BURN_PLAN in force is to be told: while a plan is in force, on each change of its targets and once a second
/// (contracts, section 4).
///
///   each cycle: if (schedule.isDue(servo) && ledger.describe(...) && send(...)) schedule.told(servo);
class PlanSchedule {
 public:
  bool isDue(const Servo& servo) noexcept
  {
    ++cycles_;
    if (servo.planReason() != retina::Reason::none) return false;
    return servo.ledger().changes() != changes_ || cycles_ >= kPeriod;
  }
  void told(const Servo& servo) noexcept
  {
    changes_ = servo.ledger().changes();
    cycles_ = 0;
  }

 private:
  static constexpr std::int64_t kPeriod = 1000;  // cycles
  std::int64_t changes_ = -1;                    // of the ledger, when it was told last
  std::int64_t cycles_ = 0;                      // since then
};

}  // namespace eyeslam::servo
