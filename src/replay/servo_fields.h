// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/replay/field_walk.h"
#include "eyeslam/replay/message_types.h"

namespace eyeslam::replay {

template <>
struct Fields<registration_t> {
  template <class Walk>
  static void list(Walk& walk, const registration_t& m)
  {
    static constexpr std::string_view kEntries[] = {"xx_px_per_m", "xy_px_per_m", "xz_px_per_m", "x1_px",
                                                    "yx_px_per_m", "yy_px_per_m", "yz_px_per_m", "y1_px"};
    static constexpr std::string_view kColumns[] = {"x", "y", "z", "1"};
    static constexpr std::string_view kUnits[] = {"px_per_m", "px_per_m", "px_per_m", "px"};
    walk.header(m);
    walk.number("valid", "", m.valid);
    walk.reason("reason", m.reason);
    walk.number("samples", "", m.samples);
    walk.vector("image_T_manipulator", "", kEntries, m.image_T_manipulator);
    walk.covariance("row_covariance", kColumns, kUnits, m.row_covariance);
    walk.number("residual_px", "", m.residual_px);
    walk.number("condition", "", m.condition);
    walk.number("um_per_px", "", m.um_per_px);
    walk.number("plane_known", "", m.plane_known);
    walk.vector("plane_normal", "", kXyz, m.plane_normal);
    walk.number("plane_offset", "m", m.plane_offset);
    walk.number("plane_residual", "m", m.plane_residual);
    walk.bytes("tag", m.tag);
  }
};

template <>
struct Fields<servo_status_t> {
  template <class Walk>
  static void list(Walk& walk, const servo_status_t& m)
  {
    walk.header(m);
    walk.choice("state", m.state, {"standby", "ready", "assist", "laser", "hold", "fault"});
    walk.reason("reason", m.reason);
    walk.number("map_id", "", m.map_id);
    walk.number("real_time", "", m.real_time);
    walk.number("pose_age", "s", m.pose_age);
    walk.number("state_age", "s", m.state_age);
    walk.number("laser_age", "s", m.laser_age);
    walk.number("operator_age", "s", m.operator_age);
    walk.number("frame_to_command", "s", m.frame_to_command);
    walk.number("computation", "s", m.computation);
    walk.number("lateness", "s", m.lateness);
    walk.number("cycles", "", m.cycles);
    walk.number("overruns", "", m.overruns);
    walk.number("messages_lost", "", m.messages_lost);
    walk.refusals("messages_refused", m.messages_refused);
  }
};

template <>
struct Fields<operator_t> {
  static constexpr std::string_view kZones[] = {"0", "1", "2", "3", "4", "5", "6", "7"};
  static constexpr std::string_view kCorners[] = {"0", "1", "2",  "3",  "4",  "5",  "6",  "7",
                                                  "8", "9", "10", "11", "12", "13", "14", "15"};

  template <class Walk>
  static void list(Walk& walk, const operator_t& m)
  {
    walk.header(m);
    walk.choice("mode", m.mode, {"standby", "ready", "assist", "laser"});
    walk.number("stop", "", m.stop);
    walk.number("arm", "", m.arm);
    walk.number("rearmed", "", m.rearmed);
    walk.number("map_id", "", m.map_id);
    walk.choice("fixture", m.fixture,
                {"no_fixture", "filter", "scaling", "point", "vessel", "standoff", "calibration"});
    walk.number("vessel", "", m.vessel);
    walk.vector("point_px", "", kXy, m.point_px);
    walk.number("standoff", "m", m.standoff);
    walk.number("lambda", "", m.lambda);
    walk.number("plan_approved", "", m.plan_approved);
    walk.bytes("plan_hash", m.plan_hash);
    walk.number("zones", "", m.zones);
    walk.vector("zone_points", "", kZones, m.zone_points);
    walk.matrix("zone_x_px", kZones, kCorners, m.zone_x_px);
    walk.matrix("zone_y_px", kZones, kCorners, m.zone_y_px);
    walk.bytes("tag", m.tag);
  }
};

}  // namespace eyeslam::replay
