// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/replay/field_walk.h"
#include "eyeslam/replay/message_types.h"

namespace eyeslam::replay {

template <>
struct Fields<mark_t> {
  template <class Walk>
  static void list(Walk& walk, const mark_t& m)
  {
    walk.header(m);
    walk.choice("kind", m.kind, {"start", "stop", "note"});
    walk.text("sender", m.sender);
    walk.text("version", m.version);
    walk.text("configuration", m.configuration);
    walk.text("configuration_hash", m.configuration_hash);
    walk.text("note", m.note);
  }
};

/// All but its targets, which are a table of their own.
template <>
struct Fields<burn_plan_t> {
  template <class Walk>
  static void list(Walk& walk, const burn_plan_t& m)
  {
    walk.header(m);
    walk.choice("state", m.state, {"proposed", "in_force"});
    walk.bytes("hash", m.hash);
    walk.bytes("map_hash", m.map_hash);
    walk.number("map_id", "", m.map_id);
    walk.number("um_per_px", "", m.um_per_px);
    walk.number("margin_um", "", m.margin_um);
    walk.number("localization_um", "", m.localization_um);
    walk.number("targets", "", m.targets);
  }
};

template <>
struct Fields<burn_target_t> {
  template <class Walk>
  static void list(Walk& walk, const burn_target_t& m)
  {
    walk.number("id", "", m.id);
    walk.choice("state", m.state, {"pending", "done", "missed", "refused"});
    walk.reason("reason", m.reason);
    walk.number("tile", "", m.tile);
    walk.number("x_px", "", m.x_px);
    walk.number("y_px", "", m.y_px);
    walk.number("spot_um", "", m.spot_um);
    walk.number("burn_um", "", m.burn_um);
    walk.number("duration", "s", m.duration);
    walk.number("power", "w", m.power);
    walk.number("clearance_um", "", m.clearance_um);
  }
};

}  // namespace eyeslam::replay
