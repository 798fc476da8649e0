// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/files/log_event.h"
#include "eyeslam/laser_command_t.hpp"
#include "eyeslam/laser_state_t.hpp"
#include "eyeslam/mark_t.hpp"
#include "eyeslam/messaging/message_header.h"
#include "eyeslam/micron_command_t.hpp"
#include "eyeslam/micron_state_t.hpp"
#include "eyeslam/operator_t.hpp"
#include "eyeslam/registration_t.hpp"
#include "eyeslam/retina_pose_t.hpp"
#include "eyeslam/servo_status_t.hpp"
#include "eyeslam/tool_tip_t.hpp"
#include "eyeslam/truth_t.hpp"
#include "eyeslam/vessel_map_t.hpp"

namespace eyeslam::replay {

/// All messages of ours, as lcmtypes/ has them today.
using MessageTypes =
    std::tuple<burn_plan_t, laser_command_t, laser_state_t, mark_t, micron_command_t, micron_state_t, operator_t,
               registration_t, retina_pose_t, servo_status_t, tool_tip_t, truth_t, vessel_map_t>;

/// A type by its names, for logs that hold any.
struct MessageType {
  std::string name;              ///< micron_state_t
  std::string channel;           ///< MICRON_STATE, on which it travels
  std::int64_t fingerprint = 0;  ///< of its fields; LCM writes it in front of each message
  bool (*hasItsLengths)(const std::uint8_t* bytes, std::size_t size) = nullptr;
};

/// In the order of MessageTypes.
const std::vector<MessageType>& messageTypes();
/// Null where the channel is not one of ours.
const MessageType* typeOfChannel(std::string_view channel);

/// What an event's bytes are to us.
enum class Standing {
  ours,          ///< whole; it can be decoded
  foreign,       ///< neither channel nor type is ours
  changed_type,  ///< on a channel of ours, but not its type of today: written by another version, or by others
  wrong_length,  ///< of our type, but cut, too long, or with a count that cannot be
};

struct JudgedEvent {
  const MessageType* type = nullptr;  ///< of today; null where foreign
  Standing standing = Standing::foreign;
  std::optional<std::int64_t> fingerprint;  ///< none where there are fewer than 8 bytes
};

JudgedEvent judge(const files::LogEvent& event);

/// Of an event that is ours, without decoding the rest: all types begin with it.
messaging::MessageHeader headerOf(const files::LogEvent& event);

}  // namespace eyeslam::replay
