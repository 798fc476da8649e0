// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/laser_messages.h"

#include "eyeslam/messaging/field_copy.h"

namespace eyeslam::messaging {
namespace {

bool isWhole(const LaserCommand& command)
{
  if (command.action == LaserAction::fire) return command.target >= 0 && command.pulse >= 1 && command.duration > 0.0;
  return command.target == -1 && command.pulse == 0 && command.duration == 0.0 && command.power == 0.0;
}

}  // namespace

template <>
struct Listing<laser_command_t> {
  template <class Copy, class Message, class Command>
  static void list(Copy& copy, Message& message, Command& command)
  {
    copy.number(message.utime_image, command.utime_image, kNotNegative);
    copy.choice(message.action, command.action, LaserAction::fire);
    copy.number(message.target, command.target, {-1.0, 1e9});
    copy.number(message.pulse, command.pulse, kNotNegative);
    copy.number(message.duration, command.duration, {0.0, 1.0});
    copy.number(message.power, command.power, {0.0, 10.0});
    copy.number(message.expiry, command.expiry, kExpiry);
    copy.require(isWhole(command));
  }
};
template struct ListedConversion<laser_command_t, LaserCommand>;

template <>
struct Listing<laser_state_t> {
  template <class Copy, class Message, class State>
  static void list(Copy& copy, Message& message, State& state)
  {
    copy.flag(message.foot_switch, state.foot_switch);
    copy.flag(message.armed, state.armed);
    copy.flag(message.interlock_closed, state.interlock_closed);
    copy.flag(message.aiming, state.aiming);
    copy.flag(message.emitting, state.emitting);
    copy.number(message.pulse, state.pulse, kNotNegative);
    copy.number(message.target, state.target, {-1.0, 1e9});
    copy.flag(message.pulse_done, state.pulse_done);
    copy.number(message.pulse_duration, state.pulse_duration, {0.0, 1.0});
    copy.reason(message.reason, state.reason);
    copy.counts(message.commands_refused, state.commands_refused);
  }
};
template struct ListedConversion<laser_state_t, LaserState>;

}  // namespace eyeslam::messaging
