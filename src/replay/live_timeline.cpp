// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/replay/message_types.h"
#include "eyeslam/replay/servo_timeline.h"
#include "eyeslam/trials/lock_step_time.h"

namespace eyeslam::replay {
namespace {

constexpr std::int64_t kPeriod_us = trials::kPeriod_us;
constexpr std::int64_t kPause_us = 10'000'000;  // nothing was logged meanwhile: nor is anything computed

bool isCommand(std::string_view channel) { return channel == "MICRON_COMMAND" || channel == "LASER_COMMAND"; }

}  // namespace

LiveTimeline::LiveTimeline(const servo::ServoConfiguration& configuration, std::int64_t session, std::int64_t start,
                           Comparison& comparison, GoalDistances& goals)
    : pairs_(comparison, goals),
      servo_(configuration, session, [this](const files::LogEvent& event) { hearItself(event); }),
      last_(start)
{}

void LiveTimeline::take(const files::LogEvent& event)
{
  newest_ = std::max(newest_, event.utime);
  if (servo_.hasSaid(event)) {
    takeSaid(event);
  } else if (RecomputedServo::hears(event.channel)) {
    heard_.emplace_back(event);
  }
  runUntil(newest_ - kLookAhead_us);
}

void LiveTimeline::finish(bool)
{
  runUntil(newest_);
  pairs_.settle();
}

// BURN_PLAN is told by another thread than the one with the cycles.
void LiveTimeline::takeSaid(const files::LogEvent& event)
{
  if (event.channel == "BURN_PLAN") return;
  const std::int64_t sent = headerOf(event).utime_sent;
  const auto place = std::upper_bound(said_.begin(), said_.end(), sent,
                                      [](std::int64_t utime, const Said& s) { return utime < s.utime_sent; });
  said_.insert(place, {sent, KeptMessage(event)});
}

void LiveTimeline::runUntil(std::int64_t utime)
{
  while (last_ < utime) {
    const std::int64_t known = said_.empty() ? utime + kPeriod_us : std::max(said_.front().utime_sent, last_ + 1);
    if (known - last_ > kPause_us) last_ = std::min(known, utime) - kPeriod_us;
    const std::int64_t next = known - last_ > kPeriod_us + kPeriod_us / 2 ? last_ + kPeriod_us : known;
    if (next > utime) return;
    cycle(next);
  }
}

void LiveTimeline::cycle(std::int64_t utime)
{
  for (; !heard_.empty() && heard_.front().utime <= utime; heard_.pop_front()) servo_.hear(heard_.front().event());
  for (; !said_.empty() && said_.front().utime_sent <= utime; said_.pop_front()) {
    KeptMessage& message = said_.front().message;
    if (message.channel == "REGISTRATION") resume(message.event());
    if (isCommand(message.channel)) pairs_.record(std::move(message));
  }
  servo_.cycle(utime);
  pairs_.settle();
  last_ = utime;
}

// A calibration from a file is told by nothing else than the first REGISTRATION.
void LiveTimeline::resume(const files::LogEvent& event)
{
  registration_t message{};
  messaging::PublishedRegistration known;
  if (registered_ || !messaging::decode(event.data, event.size, message)) return;
  if (messaging::read(message, known) != retina::Reason::none || !known.valid) return;
  registered_ = servo_.resume(known, message.utime);
}

void LiveTimeline::hearItself(const files::LogEvent& event)
{
  if (isCommand(event.channel)) pairs_.recompute(event);
  registration_t message{};
  if (event.channel == "REGISTRATION" && messaging::decode(event.data, event.size, message))
    registered_ = message.valid != 0;
}

}  // namespace eyeslam::replay
