// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/micron_messages.h"

#include "eyeslam/messaging/field_copy.h"

namespace eyeslam::messaging {
namespace {

constexpr double kFarthestDeflection = 0.01;  // m; several times any reach

template <class Copy, class Message, class Abilities>
void listAbilities(Copy& copy, Message& message, Abilities& abilities)
{
  copy.number(message.lead, abilities.lead, {0.0, 1.0});
  copy.number(message.reach_lateral, abilities.reach_lateral, {1e-6, 1.0});
  copy.number(message.reach_axial, abilities.reach_axial, {1e-6, 1.0});
  copy.number(message.cycle_rate, abilities.cycle_rate, {1.0, 1e5});
  copy.number(message.speed_limit, abilities.speed_limit, {1e-6, 10.0});
  copy.number(message.acceleration_limit, abilities.acceleration_limit, {1e-6, 1e4});
}

template <class Copy, class Message, class Limits>
void listLimits(Copy& copy, Message& message, Limits& limits)
{
  copy.bits(message.limits, 31);
  copy.bit(message.limits, micron_state_t::REACH_LATERAL, limits.lateral);
  copy.bit(message.limits, micron_state_t::REACH_AXIAL, limits.axial);
  copy.bit(message.limits, micron_state_t::SPEED, limits.speed);
  copy.bit(message.limits, micron_state_t::ACCELERATION, limits.acceleration);
  copy.bit(message.limits, micron_state_t::PIVOT, limits.pivot);
}

template <class Copy, class Message, class State>
void listFlags(Copy& copy, Message& message, State& state)
{
  copy.bits(message.flags, 31);
  copy.bit(message.flags, micron_state_t::POSE_MEASURED, state.pose_measured);
  copy.bit(message.flags, micron_state_t::POWERED, state.powered);
  copy.bit(message.flags, micron_state_t::CANCELS_TREMOR, state.cancels_tremor);
  copy.bit(message.flags, micron_state_t::FOLLOWS_COMMAND, state.follows_command);
  copy.bit(message.flags, micron_state_t::KEEPS_PIVOT, state.keeps_pivot);
}

}  // namespace

template <>
struct Listing<micron_state_t> {
  template <class Copy, class Message, class State>
  static void list(Copy& copy, Message& message, State& state)
  {
    copy.numbers(message.null_position, state.null.position, kPosition);
    copy.orientation(message.null_orientation, state.null.orientation);
    copy.numbers(message.tip_position, state.tip.position, kPosition);
    copy.orientation(message.tip_orientation, state.tip.orientation);
    copy.numbers(message.handle_position, state.handle.position, kPosition);
    copy.orientation(message.handle_orientation, state.handle.orientation);
    copy.numbers(message.goal_position, state.goal, kPosition);
    copy.flag(message.port_measured, state.port_measured);
    copy.numbers(message.port_displacement, state.port_displacement, kPosition);
    listAbilities(copy, message, state.abilities);
    listLimits(copy, message, state.limits);
    listFlags(copy, message, state);
    copy.reason(message.reason, state.reason);
    copy.number(message.command_session, state.command_session, kAnyNumber);
    copy.number(message.command_seq, state.command_seq, {-1.0, kAnyNumber.highest});
    copy.counts(message.commands_refused, state.commands_refused);
  }
};
template struct ListedConversion<micron_state_t, MicronState>;

template <>
struct Listing<micron_command_t> {
  template <class Copy, class Message, class Command>
  static void list(Copy& copy, Message& message, Command& command)
  {
    copy.number(message.utime_image, command.utime_image, kNotNegative);
    copy.choice(message.mode, command.mode, MicronMode::follow);
    copy.choice(message.reference, command.reference, GoalReference::deflection);
    copy.numbers(message.goal, command.goal, kPosition);
    copy.require(command.reference == GoalReference::tip || command.goal.norm() <= kFarthestDeflection);
    copy.require(command.mode == MicronMode::follow || command.goal.isZero(0.0));
    copy.flag(message.keep_pivot, command.keep_pivot);
    copy.numbers(message.pivot, command.pivot, kPosition);
    copy.require(command.keep_pivot || command.pivot.isZero(0.0));
    copy.number(message.speed_bound, command.speed_bound, {1e-9, 0.2});
    copy.number(message.expiry, command.expiry, kExpiry);
  }
};
template struct ListedConversion<micron_command_t, MicronCommand>;

}  // namespace eyeslam::messaging
