// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/replay/field_walk.h"
#include "eyeslam/replay/message_types.h"

namespace eyeslam::replay {

template <>
struct Fields<micron_state_t> {
  template <class Walk>
  static void list(Walk& walk, const micron_state_t& m)
  {
    using M = micron_state_t;
    walk.header(m);
    walk.vector("null_position", "m", kXyz, m.null_position);
    walk.vector("null_orientation", "", kQuaternion, m.null_orientation);
    walk.vector("tip_position", "m", kXyz, m.tip_position);
    walk.vector("tip_orientation", "", kQuaternion, m.tip_orientation);
    walk.vector("handle_position", "m", kXyz, m.handle_position);
    walk.vector("handle_orientation", "", kQuaternion, m.handle_orientation);
    walk.vector("goal_position", "m", kXyz, m.goal_position);
    walk.number("port_measured", "", m.port_measured);
    walk.vector("port_displacement", "m", kXyz, m.port_displacement);
    walk.number("lead", "s", m.lead);
    walk.number("reach_lateral", "m", m.reach_lateral);
    walk.number("reach_axial", "m", m.reach_axial);
    walk.number("cycle_rate", "per_s", m.cycle_rate);
    walk.number("speed_limit", "m_per_s", m.speed_limit);
    walk.number("acceleration_limit", "m_per_s2", m.acceleration_limit);
    walk.bits("limits", m.limits,
              {{M::REACH_LATERAL, "reach_lateral"},
               {M::REACH_AXIAL, "reach_axial"},
               {M::SPEED, "speed"},
               {M::ACCELERATION, "acceleration"},
               {M::PIVOT, "pivot"}});
    walk.bits("flags", m.flags,
              {{M::POSE_MEASURED, "pose_measured"},
               {M::POWERED, "powered"},
               {M::CANCELS_TREMOR, "cancels_tremor"},
               {M::FOLLOWS_COMMAND, "follows_command"},
               {M::KEEPS_PIVOT, "keeps_pivot"}});
    walk.reason("reason", m.reason);
    walk.number("command_session", "", m.command_session);
    walk.number("command_seq", "", m.command_seq);
    walk.refusals("commands_refused", m.commands_refused);
    walk.bytes("tag", m.tag);
  }
};

template <>
struct Fields<micron_command_t> {
  template <class Walk>
  static void list(Walk& walk, const micron_command_t& m)
  {
    walk.header(m);
    walk.number("utime_image", "us", m.utime_image);
    walk.choice("mode", m.mode, {"at_null", "cancel_tremor", "follow"});
    walk.choice("reference", m.reference, {"tip", "deflection"});
    walk.vector("goal", "m", kXyz, m.goal);
    walk.number("keep_pivot", "", m.keep_pivot);
    walk.vector("pivot", "m", kXyz, m.pivot);
    walk.number("speed_bound", "m_per_s", m.speed_bound);
    walk.number("expiry", "s", m.expiry);
    walk.bytes("tag", m.tag);
  }
};

template <>
struct Fields<laser_command_t> {
  template <class Walk>
  static void list(Walk& walk, const laser_command_t& m)
  {
    walk.header(m);
    walk.number("utime_image", "us", m.utime_image);
    walk.choice("action", m.action, {"off", "aim", "fire"});
    walk.number("target", "", m.target);
    walk.number("pulse", "", m.pulse);
    walk.number("duration", "s", m.duration);
    walk.number("power", "w", m.power);
    walk.number("expiry", "s", m.expiry);
    walk.bytes("tag", m.tag);
  }
};

template <>
struct Fields<laser_state_t> {
  template <class Walk>
  static void list(Walk& walk, const laser_state_t& m)
  {
    walk.header(m);
    walk.number("foot_switch", "", m.foot_switch);
    walk.number("armed", "", m.armed);
    walk.number("interlock_closed", "", m.interlock_closed);
    walk.number("aiming", "", m.aiming);
    walk.number("emitting", "", m.emitting);
    walk.number("pulse", "", m.pulse);
    walk.number("target", "", m.target);
    walk.number("pulse_done", "", m.pulse_done);
    walk.number("pulse_duration", "s", m.pulse_duration);
    walk.reason("reason", m.reason);
    walk.refusals("commands_refused", m.commands_refused);
    walk.bytes("tag", m.tag);
  }
};

}  // namespace eyeslam::replay
