// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "eyeslam/messaging/channel_guard.h"
#include "eyeslam/messaging/conversion.h"
#include "eyeslam/micron_command_t.hpp"
#include "eyeslam/micron_state_t.hpp"
#include "eyeslam/retina/reason.h"

namespace eyeslam::messaging {

/// Where a part of the tool is: manipulator's frame, m, right-handed; its axes as a unit quaternion, z along the shaft,
/// from the handle towards the tip.
struct ToolPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// What bounded the tip in a cycle of the controller.
struct LimitsReached {
  bool lateral = false;  ///< reach across the shaft
  bool axial = false;    ///< reach along the shaft
  bool speed = false;
  bool acceleration = false;
  bool pivot = false;  ///< the remote centre of motion could not be kept

  bool any() const { return lateral || axial || speed || acceleration || pivot; }
};

/// What the controller can do; s, m, 1/s.
struct MicronAbilities {
  double lead = 0.0048;              ///< of the plant: command delay + 2 damping / bandwidth
  double reach_lateral = 0.002;      ///< radius of the cylinder about the null tip along the shaft
  double reach_axial = 0.002;        ///< half of its height
  double cycle_rate = 1000.0;        ///< of the controller
  double speed_limit = 0.03;         ///< m/s
  double acceleration_limit = 10.0;  ///< m/s^2
};

/// What the controller measures and does (MICRON_STATE).
struct MicronState {
  ToolPose null;    ///< of the tip, with the manipulator in the middle of its range: what the hand intends
  ToolPose tip;     ///< measured
  ToolPose handle;  ///< measured
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();  ///< of the tip, that is followed now; the null where none is
  bool port_measured = false;
  Eigen::Vector3d port_displacement = Eigen::Vector3d::Zero();  ///< m, of the port in the sclera from its rest
  MicronAbilities abilities;
  LimitsReached limits;
  bool pose_measured = false;    ///< handle and tip are seen
  bool powered = false;          ///< actuators
  bool cancels_tremor = false;   ///< by the controller's own filter
  bool follows_command = false;  ///< the last command taken moves the tip
  bool keeps_pivot = false;
  retina::Reason reason = retina::Reason::none;  ///< why no command is followed
  std::int64_t command_session = 0;              ///< of the last command taken; 0 before the first
  std::int64_t command_seq = -1;                 ///< of the last command taken; -1 before the first
  Refusals commands_refused{};                   ///< since the start
};

enum class MicronMode { at_null, cancel_tremor, follow };
enum class GoalReference { tip, deflection };  ///< who subtracts the null: the controller (tip) or the servo

/// What the servo wants of the tip (MICRON_COMMAND); m, m/s, s, manipulator's frame.
struct MicronCommand {
  std::int64_t utime_image = 0;  ///< us since 1970, mid-exposure of the newest image used; 0 = none
  MicronMode mode = MicronMode::cancel_tremor;
  GoalReference reference = GoalReference::tip;
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();  ///< zero unless following
  bool keep_pivot = false;
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< remote centre of motion; zero unless kept
  double speed_bound = 0.02;                        ///< (0, 0.2]
  double expiry = 0.05;                             ///< after sending, (0, 1]; source: contracts, section 4
};

template <>
struct Conversion<micron_state_t> : ListedConversion<micron_state_t, MicronState> {};
template <>
struct Conversion<micron_command_t> : ListedConversion<micron_command_t, MicronCommand> {};

}  // namespace eyeslam::messaging
