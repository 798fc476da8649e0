// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/messaging/map_assembler.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/messaging/subscription.h"

namespace eyeslam::support {

/// Listens to all channels of one link, and puts the map together.
struct EverySubscription {
  messaging::Link& link;
  messaging::MapAssembler maps;
  messaging::Subscription<burn_plan_t> burn_plan{link};
  messaging::Subscription<laser_command_t> laser_command{link};
  messaging::Subscription<laser_state_t> laser_state{link};
  messaging::Subscription<mark_t> mark{link};
  messaging::Subscription<micron_command_t> micron_command{link};
  messaging::Subscription<micron_state_t> micron_state{link};
  messaging::Subscription<operator_t> wish{link};
  messaging::Subscription<registration_t> registration{link};
  messaging::Subscription<retina_pose_t> retina_pose{link};
  messaging::Subscription<servo_status_t> servo_status{link};
  messaging::Subscription<tool_tip_t> tool_tip{link};
  messaging::Subscription<vessel_map_t> vessel_map{
      link, [this](const vessel_map_t& tile, const messaging::MessageHeader&) { maps.add(tile); }};

  std::array<messaging::ChannelReceiver*, 12> all()
  {
    return {&burn_plan, &laser_command, &laser_state, &mark,         &micron_command, &micron_state,
            &wish,      &registration,  &retina_pose, &servo_status, &tool_tip,       &vessel_map};
  }
};

}  // namespace eyeslam::support
