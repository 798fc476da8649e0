// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/replay/field_walk.h"
#include "eyeslam/replay/message_types.h"

namespace eyeslam::replay {

template <>
struct Fields<retina_pose_t> {
  template <class Walk>
  static void list(Walk& walk, const retina_pose_t& m)
  {
    static constexpr std::string_view kAxes[] = {"x", "y", "theta"}, kUnits[] = {"px", "px", "rad"};
    walk.header(m);
    walk.number("frame", "", m.frame);
    walk.number("exposure", "s", m.exposure);
    walk.number("tracked", "", m.tracked);
    walk.reason("reason", m.reason);
    walk.number("x_px", "", m.x_px);
    walk.number("y_px", "", m.y_px);
    walk.number("theta", "rad", m.theta);
    walk.number("scale", "", m.scale);
    walk.number("velocity_x_px", "per_s", m.velocity_x_px);
    walk.number("velocity_y_px", "per_s", m.velocity_y_px);
    walk.number("velocity_theta", "rad_per_s", m.velocity_theta);
    walk.covariance("covariance", kAxes, kUnits, m.covariance);
    walk.number("map_id", "", m.map_id);
    walk.number("map_version", "", m.map_version);
    walk.number("um_per_px", "", m.um_per_px);
    walk.bytes("tag", m.tag);
  }
};

template <>
struct Fields<tool_tip_t> {
  template <class Walk>
  static void list(Walk& walk, const tool_tip_t& m)
  {
    static constexpr std::string_view kUnits[] = {"px", "px"};
    walk.header(m);
    walk.number("frame", "", m.frame);
    walk.number("exposure", "s", m.exposure);
    walk.number("tip_present", "", m.tip_present);
    walk.number("tip_x_px", "", m.tip_x_px);
    walk.number("tip_y_px", "", m.tip_y_px);
    walk.number("shaft_angle", "rad", m.shaft_angle);
    walk.number("shaft_width_px", "", m.shaft_width_px);
    walk.covariance("tip_covariance", kXy, kUnits, m.tip_covariance);
    walk.number("spot_present", "", m.spot_present);
    walk.number("spot_x_px", "", m.spot_x_px);
    walk.number("spot_y_px", "", m.spot_y_px);
    walk.covariance("spot_covariance", kXy, kUnits, m.spot_covariance);
    walk.bytes("tag", m.tag);
  }
};

template <>
struct Fields<vessel_map_t> {
  template <class Walk>
  static void list(Walk& walk, const vessel_map_t& m)
  {
    walk.header(m);
    walk.number("map_id", "", m.map_id);
    walk.number("map_version", "", m.map_version);
    walk.number("map_width", "", m.map_width);
    walk.number("map_height", "", m.map_height);
    walk.number("origin_x_px", "", m.origin_x_px);
    walk.number("origin_y_px", "", m.origin_y_px);
    walk.number("px_per_cell", "", m.px_per_cell);
    walk.number("um_per_px", "", m.um_per_px);
    walk.number("column", "", m.column);
    walk.number("row", "", m.row);
    walk.number("width", "", m.width);
    walk.number("height", "", m.height);
    walk.number("cells", "", m.cells);
    walk.bytes("probability", m.probability);
    walk.bytes("calibre_px", m.calibre_px);
    walk.bytes("seen", m.seen);
    walk.bytes("tag", m.tag);
  }
};

template <>
struct Fields<truth_t> {
  template <class Walk>
  static void list(Walk& walk, const truth_t& m)
  {
    walk.header(m);
    walk.number("um_per_px", "", m.um_per_px);
    walk.vector("retina_centre", "m", kXy, m.retina_centre);
    walk.vector("retina_shift", "m", kXyz, m.retina_shift);
    walk.number("retina_theta", "rad", m.retina_theta);
    walk.vector("tip", "m", kXyz, m.tip);
    walk.vector("null", "m", kXyz, m.null);
    walk.vector("spot", "m", kXy, m.spot);
    walk.vector("shaft", "", kXyz, m.shaft);
    walk.number("pivot_error", "m", m.pivot_error);
    walk.number("saturated", "", m.saturated);
    walk.number("jerk", "", m.jerk);
    walk.vector("jerked", "m", kXy, m.jerked);
    walk.number("emitting", "", m.emitting);
    walk.number("frame", "", m.frame);
    walk.number("frame_utime", "us", m.frame_utime);
    walk.number("frame_x_px", "", m.frame_x_px);
    walk.number("frame_y_px", "", m.frame_y_px);
    walk.number("frame_theta", "rad", m.frame_theta);
  }
};

}  // namespace eyeslam::replay
