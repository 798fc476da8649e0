// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/subscription.h"

namespace eyeslam::servo {

/// All that the loop listens to: messages of fixed size only. The command channels are its own; whoever else speaks on
/// them is a rival.
struct ServoEars {
  explicit ServoEars(messaging::Link& link)
      : session(link.session()),
        states(link),
        lasers(link),
        operators(link),
        poses(link),
        tips(link),
        motion_commands(link),
        laser_commands(link)
  {}

  template <class Visit>
  void forEach(const Visit& visit) const
  {
    visit(states);
    visit(lasers);
    visit(operators);
    visit(poses);
    visit(tips);
    visit(motion_commands);
    visit(laser_commands);
  }

  /// A human re-armed: every channel may be spoken on by another session. One's own keep their place on one's own
  /// channels, or a rival would take it for good.
  void acceptNewSessions()
  {
    states.acceptNewSession();
    lasers.acceptNewSession();
    operators.acceptNewSession();
    poses.acceptNewSession();
    tips.acceptNewSession();
    if (motion_commands.session() != session) motion_commands.acceptNewSession();
    if (laser_commands.session() != session) laser_commands.acceptNewSession();
  }

  std::int64_t session;  ///< one's own
  messaging::Subscription<micron_state_t> states;
  messaging::Subscription<laser_state_t> lasers;
  messaging::Subscription<operator_t> operators;
  messaging::Subscription<retina_pose_t> poses;
  messaging::Subscription<tool_tip_t> tips;
  messaging::Subscription<micron_command_t> motion_commands;
  messaging::Subscription<laser_command_t> laser_commands;
};

}  // namespace eyeslam::servo
