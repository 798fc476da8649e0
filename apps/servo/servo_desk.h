// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/servo/preparation.h"
#include "eyeslam/servo/servo_configuration.h"
#include "servo/servo_exchanges.h"

namespace eyeslam::apps {

/// All that takes longer than a millisecond, beside the loop: vessel graphs of new maps, judging plans on them,
/// evaluating calibrations, telling which plan is in force.
class ServoDesk {
 public:
  struct Answers {
    std::function<void(const std::string& line)> say;
    std::function<void(const messaging::PublishedRegistration&)> keep;  ///< of a good calibration
  };

  /// @param link  its own: whole maps and plans come on it
  ServoDesk(const servo::ServoConfiguration& options, messaging::Link& link, ServoExchanges& exchanges,
            Answers answers);

  /// The loop goes on from an earlier calibration. @return whether it is good enough
  bool resume(const messaging::PublishedRegistration& published);

  /// A turn, after the link was drained; some 30 ms where the map has changed.
  void work(const messaging::ReceiveTime& now);

 private:
  void evaluate(std::int64_t utime);
  void tell(const servo::CalibrationResult& result, std::int64_t utime);
  void publishPlan(std::int64_t utime);

  servo::ServoConfiguration options_;
  ServoExchanges& exchanges_;
  Answers answers_;
  servo::PreparationDesk preparation_;
  messaging::Publisher<burn_plan_t> plans_;
  SamplesBuffer samples_ = samplesBuffer();
  PlanBuffer plan_ = planBuffer();
};

}  // namespace eyeslam::apps
