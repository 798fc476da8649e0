// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/recomputed_servo.h"

#include <algorithm>
#include <utility>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/replay/message_types.h"

namespace eyeslam::replay {
namespace {

constexpr std::string_view kHeard[] = {"MICRON_STATE", "LASER_STATE", "OPERATOR",       "RETINA_POSE",  "TOOL_TIP",
                                       "VESSEL_MAP",   "BURN_PLAN",   "MICRON_COMMAND", "LASER_COMMAND"};
constexpr std::string_view kSaid[] = {"MICRON_COMMAND", "LASER_COMMAND", "SERVO_STATUS", "REGISTRATION"};

template <std::size_t kSize>
bool isAmong(const std::string_view (&names)[kSize], std::string_view name)
{
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

// One channel for both: what is proposed, and what is in force.
bool isInForce(const files::LogEvent& event)
{
  burn_plan_t plan{};
  return messaging::decode(event.data, event.size, plan) && plan.state == burn_plan_t::IN_FORCE;
}

}  // namespace

RecomputedServo::RecomputedServo(const trials::TrialSetting& setting, std::int64_t session, Each each)
    : link_("memq://", session, std::nullopt),
      tap_(link_, [this](const messaging::TappedEvent& event) { tell(event); }),
      servo_(setting, link_),
      each_(std::move(each))
{}

RecomputedServo::RecomputedServo(const servo::ServoConfiguration& configuration, std::int64_t session, Each each)
    : link_("memq://", session, std::nullopt),
      tap_(link_, [this](const messaging::TappedEvent& event) { tell(event); }),
      servo_(configuration, std::nullopt, link_),
      each_(std::move(each))
{}

bool RecomputedServo::hears(std::string_view channel) { return isAmong(kHeard, channel); }

bool RecomputedServo::hasSaid(const files::LogEvent& event) const
{
  if (event.channel == "BURN_PLAN") return headerOf(event).session == session() && isInForce(event);
  return isAmong(kSaid, event.channel) && headerOf(event).session == session();
}

void RecomputedServo::hear(const files::LogEvent& event)
{
  channel_.assign(event.channel);
  link_.send(channel_, event.data, event.size);
}

void RecomputedServo::cycle(std::int64_t utime)
{
  const messaging::ReceiveTime now{utime, utime};
  tap_.setTime(utime);
  link_.drain(now);
  servo_.cycle(now);
  speaks_ = true;
  link_.drain(now);
  speaks_ = false;
  tap_.setTime(utime);  // throws what `each` threw
}

void RecomputedServo::tell(const messaging::TappedEvent& event)
{
  if (speaks_) each_({said_++, event.utime, event.channel, event.data, event.size});
}

}  // namespace eyeslam::replay
