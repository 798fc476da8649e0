// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/laser_command_t.hpp"
#include "eyeslam/laser_state_t.hpp"
#include "eyeslam/messaging/channel_guard.h"
#include "eyeslam/messaging/conversion.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::messaging {

enum class LaserAction { off, aim, fire };

/// What the servo wants of the laser (LASER_COMMAND); s, W. Held: repeated every cycle while it is meant.
struct LaserCommand {
  std::int64_t utime_image = 0;  ///< us since 1970, mid-exposure of the newest image used; 0 = none
  LaserAction action = LaserAction::off;
  int target = -1;         ///< id in the plan in force; -1 unless firing
  std::int64_t pulse = 0;  ///< number of the pulse in this session, from 1, the same while held; 0 unless firing
  double duration = 0.0;   ///< (0, 1]; 0 unless firing
  double power = 0.0;      ///< [0, 10]; 0 unless firing
  double expiry = 0.005;   ///< after sending, (0, 1]; source: contracts, section 4
};

/// What the laser says of itself (LASER_STATE).
struct LaserState {
  bool foot_switch = false;       ///< pressed
  bool armed = false;             ///< by the laser's own controls
  bool interlock_closed = false;  ///< open prevents all emission
  bool aiming = false;
  bool emitting = false;
  std::int64_t pulse = 0;  ///< number of the last pulse begun; 0 before the first
  int target = -1;         ///< of that pulse
  bool pulse_done = false;
  double pulse_duration = 0.0;                   ///< s, emitted so far
  retina::Reason reason = retina::Reason::none;  ///< why the last firing was not obeyed
  Refusals commands_refused{};                   ///< since the start
};

template <>
struct Conversion<laser_command_t> : ListedConversion<laser_command_t, LaserCommand> {};
template <>
struct Conversion<laser_state_t> : ListedConversion<laser_state_t, LaserState> {};

}  // namespace eyeslam::messaging
