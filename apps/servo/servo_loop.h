// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>

#include "eyeslam/messaging/link.h"
#include "eyeslam/servo/plan_schedule.h"
#include "eyeslam/servo/servo.h"
#include "real_time/real_time_loop.h"
#include "servo/cycle_record.h"
#include "servo/servo_exchanges.h"

namespace eyeslam::apps {

/// What the loop's thread does each millisecond: hears, takes what was prepared beside it, lets the servo decide and
/// speak, leaves its status. Nothing in it waits for anybody.
class ServoLoop {
 public:
  /// @param link       the loop's own: it hears messages of fixed size only
  /// @param real_time  whether the thread is scheduled so and its memory locked
  ServoLoop(const servo::ServoOptions& options, messaging::Link& link, ServoExchanges& exchanges, bool real_time,
            CycleRecord& record, messaging::Clocks clocks);

  /// @return whether there shall be another cycle: not when it closes and nothing is commanded any more
  bool cycle(const CycleStart& start);

 private:
  void takeWhatWasPrepared(std::int64_t utime);
  void leaveSamples();
  void leavePlan();

  messaging::Link& link_;
  messaging::Clocks clocks_;
  ServoExchanges& exchanges_;
  CycleRecord& record_;
  bool real_time_;
  servo::Servo servo_;
  // What was given back by the servo stays here until the patient thread can have it.
  std::shared_ptr<const servo::Preparation> preparation_;
  std::shared_ptr<const servo::CalibrationResult> calibration_;
  const servo::Preparation* in_use_ = nullptr;
  SamplesBuffer samples_ = samplesBuffer();
  PlanBuffer plan_ = planBuffer();
  servo::PlanSchedule schedule_;
  messaging::ServoStatus status_;
};

}  // namespace eyeslam::apps
