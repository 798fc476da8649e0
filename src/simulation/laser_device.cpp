// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/laser_device.h"

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

using messaging::LaserAction;
using messaging::LaserCommand;
using retina::Reason;

LaserDevice::LaserDevice(const LaserDeviceOptions& options, double period_s)
    : longest_command_(options.expiry_ms * kMilli),
      longest_pulse_(options.longest_pulse_ms * kMilli),
      highest_power_(options.highest_power_w),
      period_s_(period_s)
{}

Reason LaserDevice::whyNoEmission() const
{
  if (!state_.interlock_closed) return Reason::interlock_open;
  if (!state_.armed) return Reason::not_armed;
  if (!state_.foot_switch) return Reason::foot_switch_up;
  return Reason::none;
}

Reason LaserDevice::whyNoPulse(const LaserCommand& command) const
{
  if (const Reason why = whyNoEmission(); why != Reason::none) return why;
  if (command.duration > longest_pulse_) return Reason::pulse_too_long;
  if (command.power > highest_power_) return Reason::power_too_high;
  return Reason::none;
}

void LaserDevice::end(Reason why)
{
  state_.emitting = false;
  state_.pulse_done = true;
  state_.reason = why;
}

// One period of a pulse has passed; does it go on?
void LaserDevice::emit(const LaserCommand* command)
{
  state_.pulse_duration += period_s_;
  if (state_.pulse_duration >= duration_ - 0.5 * period_s_) return end(Reason::none);
  if (const Reason why = whyNoEmission(); why != Reason::none) return end(why);
  const bool held = command != nullptr && command->action == LaserAction::fire && command->pulse == state_.pulse;
  if (!held) end(Reason::command_lapsed);
}

void LaserDevice::consider(const LaserCommand& command, std::int64_t session)
{
  if (session != session_) {
    session_ = session;
    spent_ = 0;
  }
  if (command.pulse <= spent_) return;
  spent_ = command.pulse;
  state_.reason = whyNoPulse(command);
  if (state_.reason != Reason::none) return;
  duration_ = command.duration;
  power_ = command.power;
  state_.pulse = command.pulse;
  state_.target = command.target;
  state_.pulse_duration = 0.0;
  state_.pulse_done = false;
  state_.emitting = true;
}

const messaging::LaserState& LaserDevice::step(const LaserSwitches& switches, const HeardCommand<LaserCommand>& heard)
{
  state_.foot_switch = switches.foot_switch;
  state_.armed = switches.armed;
  state_.interlock_closed = switches.interlock_closed;
  state_.commands_refused = heard.refused;
  const bool in_force = heard.whyNotInForce(longest_command_) == Reason::none;
  const LaserCommand* command = in_force ? heard.command : nullptr;
  if (state_.emitting) {
    emit(command);
  } else if (command != nullptr && command->action == LaserAction::fire) {
    consider(*command, heard.session);
  }
  state_.aiming = command != nullptr && command->action != LaserAction::off && state_.interlock_closed;
  return state_;
}

}  // namespace eyeslam::simulation
