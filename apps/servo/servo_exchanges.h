// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <memory>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/servo/calibration.h"
#include "eyeslam/servo/preparation.h"
#include "real_time/exchange.h"

namespace eyeslam::apps {

using SamplesBuffer = std::unique_ptr<servo::CalibrationSamples>;
using PlanBuffer = std::unique_ptr<burn_plan_t>;

inline SamplesBuffer samplesBuffer() { return std::make_unique<servo::CalibrationSamples>(); }
/// With room for the largest plan, so that the loop never allocates.
inline PlanBuffer planBuffer()
{
  auto plan = std::make_unique<burn_plan_t>();
  plan->target.reserve(messaging::kMostTargets);
  return plan;
}

/// What the loop's thread and the patient one hand to each other.
struct ServoExchanges {
  // To the loop; what it gives back is freed by the patient thread. Shared, because their makers keep them, too.
  Exchange<std::shared_ptr<const servo::Preparation>> preparations;
  Exchange<std::shared_ptr<const servo::CalibrationResult>> calibrations;
  std::atomic<bool> closes{false};  ///< hand over to the controller, and end

  // From the loop, in buffers that go back and forth.
  Exchange<messaging::ServoStatus> statuses;
  Exchange<SamplesBuffer> samples{samplesBuffer()};  ///< of a sweep that is over
  Exchange<PlanBuffer> plans{planBuffer()};          ///< in force, with the state of each target
};

}  // namespace eyeslam::apps
