// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/health_monitor.h"

namespace eyeslam::servo {

using retina::Reason;

namespace {

std::int64_t microsecondsOf(double milliseconds) { return static_cast<std::int64_t>(1e3 * milliseconds); }

}  // namespace

// Messages on one's own channels that were not one's own: heard, because nobody had spoken before, or refused.
std::int64_t HealthMonitor::commandsOfOthers() noexcept
{
  std::int64_t refused = 0;
  std::size_t i = 0;
  for (const messaging::ChannelReceiver* channel :
       {static_cast<const messaging::ChannelReceiver*>(&ears_.motion_commands),
        static_cast<const messaging::ChannelReceiver*>(&ears_.laser_commands)}) {
    const bool is_own = channel->session() == ears_.session;
    if (!is_own) rival_messages_ += channel->accepted() - last_accepted_[i];
    last_accepted_[i++] = channel->accepted();
    refused += channel->refused(Reason::wrong_session);
  }
  return refused + rival_messages_;
}

HealthMonitor::Seen HealthMonitor::seenNow() noexcept
{
  return {ears_.states.refused(Reason::wrong_session), ears_.states.refused(Reason::not_finite), commandsOfOthers()};
}

void HealthMonitor::count(std::int64_t monotonic) noexcept
{
  std::size_t i = 0;
  ears_.forEach([&](const messaging::ChannelReceiver& channel) { watches_[i++].update(channel.refused(), monotonic); });
  if (const auto* state = ears_.states.latest()) watches_[i].update(state->commands_refused, monotonic);
  if (const auto* laser = ears_.lasers.latest()) watches_[i + 1].update(laser->commands_refused, monotonic);
}

void HealthMonitor::forget() noexcept
{
  for (RefusalWatch& watch : watches_) watch.forget();
  now_ = seenNow();
}

Reason HealthMonitor::clock() const noexcept
{
  Reason fault = Reason::none;
  ears_.forEach([&fault](const messaging::ChannelReceiver& channel) {
    if (fault == Reason::none) fault = channel.fault();
  });
  return fault;
}

Reason HealthMonitor::controller() const noexcept
{
  if (now_.states_not_finite > before_.states_not_finite) return Reason::state_not_finite;
  if (now_.states_of_others > before_.states_of_others) return Reason::controller_restarted;
  const messaging::MicronState* state = ears_.states.latest();
  return state && !state->powered ? Reason::unpowered : Reason::none;
}

Reason HealthMonitor::rival() const noexcept
{
  return now_.commands_of_others > before_.commands_of_others ? Reason::rival_servo : Reason::none;
}

Reason HealthMonitor::stateLink(const LoopSigns& signs, std::int64_t monotonic) const noexcept
{
  if (signs.state != Reason::none) return signs.state;
  return ears_.states.silence(monotonic) > microsecondsOf(options_.state_silence_ms) ? Reason::state_stale
                                                                                     : Reason::none;
}

Reason HealthMonitor::messages(std::int64_t monotonic) const noexcept
{
  for (const RefusalWatch& watch : watches_) {
    const Reason reason = watch.tooMany(monotonic, microsecondsOf(options_.refusal_window_ms),
                                        static_cast<std::size_t>(options_.most_refused));
    if (reason != Reason::none) return reason;
  }
  return Reason::none;
}

// Where vision still speaks it knows better than anybody why it sees nothing.
Reason HealthMonitor::retinaOf(const LoopSigns& signs, std::int64_t monotonic) const noexcept
{
  if (signs.retina == Reason::none || signs.retina == Reason::pose_jumped) return signs.retina;
  const messaging::RetinaPose* pose = ears_.poses.latest();
  const bool speaks = ears_.poses.silence(monotonic) <= microsecondsOf(options_.pose_silence_ms);
  const bool explains = pose && speaks && !pose->motion.tracked && pose->motion.reason != Reason::none;
  return explains ? pose->motion.reason : signs.retina;
}

const Health& HealthMonitor::judge(const LoopSigns& signs, std::int64_t monotonic) noexcept
{
  before_ = now_;
  now_ = seenNow();
  count(monotonic);
  health_.cycle = signs.cycle;
  health_.clock = clock();
  health_.controller = controller();
  health_.rival = rival();
  health_.state_link = stateLink(signs, monotonic);
  const bool heard = ears_.operators.silence(monotonic) <= microsecondsOf(options_.operator_silence_ms);
  health_.operator_link = heard ? Reason::none : Reason::operator_stale;
  health_.messages = messages(monotonic);
  if (health_.messages == Reason::none) health_.messages = signs.commands;
  health_.registration = signs.registration;
  health_.retina = retinaOf(signs, monotonic);
  health_.fixture = signs.fixture;
  health_.plan = signs.plan;
  return health_;
}

}  // namespace eyeslam::servo
