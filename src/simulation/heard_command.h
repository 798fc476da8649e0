// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

#include "eyeslam/messaging/channel_guard.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::simulation {

/// What a device has heard of those who command it, at an instant.
template <class Command>
struct HeardCommand {
  const Command* command = nullptr;  ///< the last one accepted; null before the first
  double age = 0.0;                  ///< s since it was sent, by the device's own clock
  std::int64_t session = 0;          ///< of its sender
  std::int64_t seq = -1;
  retina::Reason fault = retina::Reason::none;  ///< why nothing is heard any more
  messaging::Refusals refused{};                ///< since the start

  /// @param longest  s: the device's own bound on a command's life, whatever the command says
  /// @return none when the command is to be obeyed now; else no_command, expired, clock_stepped
  retina::Reason whyNotInForce(double longest) const
  {
    if (fault != retina::Reason::none) return fault;
    if (command == nullptr) return retina::Reason::no_command;
    return age <= std::min(command->expiry, longest) ? retina::Reason::none : retina::Reason::expired;
  }
};

/// @param monotonic  the receiver's clock, us
template <class Message>
auto heardOn(const messaging::Subscription<Message>& commands, std::int64_t monotonic)
{
  using Command = typename messaging::Subscription<Message>::Value;
  HeardCommand<Command> heard;
  heard.command = commands.latest();
  heard.fault = commands.fault();
  heard.refused = commands.refused();
  if (heard.command != nullptr) {
    heard.age = 1e-6 * static_cast<double>(monotonic - commands.toReceiver(commands.header().utime_sent));
    heard.session = commands.header().session;
    heard.seq = commands.header().seq;
  }
  return heard;
}

}  // namespace eyeslam::simulation
