// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/status_report.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/servo/loop_time.h"

namespace eyeslam::servo {

namespace {

double reportedAge(const messaging::ChannelReceiver& channel, std::int64_t monotonic)
{
  return channel.accepted() == 0 ? -1.0 : seconds(channel.silence(monotonic));
}

// A clock that went wrong must not keep the status from being sent.
double atMost(double value, double most) { return value > 0.0 ? std::min(value, most) : 0.0; }

}  // namespace

void StatusReport::gather(const ServoEars& ears, const CycleTiming& timing, std::int64_t monotonic) noexcept
{
  if (published_) status_.computation = status_.lateness = 0.0;
  published_ = false;
  status_.real_time = timing.real_time;
  status_.computation = std::max(status_.computation, atMost(timing.computation_s, 1.0));
  status_.lateness = std::max(status_.lateness, atMost(timing.lateness_s, 1e3));
  status_.overruns = timing.overruns;
  ++status_.cycles;
  status_.state_age = reportedAge(ears.states, monotonic);
  status_.laser_age = reportedAge(ears.lasers, monotonic);
  status_.operator_age = reportedAge(ears.operators, monotonic);
  status_.messages_lost = 0;
  status_.messages_refused = {};
  ears.forEach([this](const messaging::ChannelReceiver& channel) {
    status_.messages_lost += channel.lost();
    for (std::size_t i = 0; i < messaging::kRefusalReasons; ++i) status_.messages_refused[i] += channel.refused()[i];
  });
}

void StatusReport::setState(messaging::ServoState state, retina::Reason reason) noexcept
{
  changed_ = changed_ || state != status_.state || reason != status_.reason;
  status_.state = state;
  status_.reason = reason;
}

void StatusReport::setPose(std::int64_t map_id, double age_s) noexcept
{
  status_.map_id = map_id;
  status_.pose_age = age_s >= 0.0 ? age_s : -1.0;
}

bool StatusReport::isDue(std::int64_t monotonic) noexcept
{
  if (!changed_ && monotonic - last_ < period_) return false;
  changed_ = false;
  published_ = true;
  last_ = monotonic;
  return true;
}

}  // namespace eyeslam::servo
