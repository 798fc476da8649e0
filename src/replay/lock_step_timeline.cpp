// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "eyeslam/replay/recomputed_part.h"
#include "eyeslam/replay/servo_timeline.h"
#include "eyeslam/trials/lock_step_time.h"

namespace eyeslam::replay {

LockStepTimeline::LockStepTimeline(const trials::TrialSetting& setting, std::int64_t session, std::int64_t start,
                                   Comparison& comparison, GoalDistances& goals)
    : utime_(start),
      pairs_(comparison, goals),
      servo_(setting, session, [this](const files::LogEvent& event) { pairs_.recompute(event); })
{}

void LockStepTimeline::take(const files::LogEvent& event)
{
  if (event.utime - utime_ > kLongestGap_us) {
    throw ReplayError(fmt::format("nothing is recorded for {:.0f} s at {:.3f} s of the trial: its servo cannot go on",
                                  1e-6 * static_cast<double>(event.utime - utime_),
                                  1e-6 * static_cast<double>(utime_ - trials::kStart_us)));
  }
  while (utime_ < event.utime) cycle();
  if (servo_.hasSaid(event)) {
    pairs_.record(KeptMessage(event));
  } else if (RecomputedServo::hears(event.channel)) {
    servo_.hear(event);
  }
}

void LockStepTimeline::finish(bool whole)
{
  if (whole) cycle();
}

void LockStepTimeline::cycle()
{
  servo_.cycle(utime_);
  pairs_.settle();
  utime_ += trials::kPeriod_us;
}

}  // namespace eyeslam::replay
