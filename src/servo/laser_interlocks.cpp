// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/laser_interlocks.h"

#include <algorithm>
#include <array>

namespace eyeslam::servo {

using retina::Reason;

namespace {

using C = PulseConditions;
using O = LaserInterlocksOptions;

struct Interlock {
  Reason reason;
  bool (*closed)(const C& now, const O& options);
};

constexpr double ms(double value) { return value * 1e-3; }
constexpr double um(double value) { return value * 1e-6; }

double oldestPose(const O& o) { return ms(std::min(o.oldest_pose_ms, o.latency_ms + o.frame_ms)); }

// Every comparison is written so that NaN leaves the interlock open.
constexpr std::array kAlways{
    Interlock{Reason::not_in_laser, [](const C& c, const O&) { return c.laser_state; }},
    Interlock{Reason::foot_switch_up, [](const C& c, const O&) { return c.foot_switch; }},
    Interlock{Reason::not_armed, [](const C& c, const O&) { return c.armed_by_human && c.armed_laser; }},
    Interlock{Reason::interlock_open, [](const C& c, const O&) { return c.interlock_closed; }},
    Interlock{Reason::laser_stale, [](const C& c, const O& o) { return c.laser_age <= ms(o.laser_age_ms); }},
    Interlock{Reason::operator_stale, [](const C& c, const O& o) { return c.operator_age <= ms(o.operator_age_ms); }},
    Interlock{Reason::plan_not_in_force, [](const C& c, const O&) { return c.plan_in_force; }},
    Interlock{Reason::target_invalid, [](const C& c, const O&) { return c.target_valid; }},
    Interlock{Reason::registration_uncertain, [](const C& c, const O&) { return c.registered; }},
    Interlock{Reason::retina_lost, [](const C& c, const O&) { return c.tracked; }},
    Interlock{Reason::pose_stale, [](const C& c, const O& o) { return c.pose_age <= oldestPose(o); }},
    Interlock{Reason::pose_uncertain, [](const C& c, const O& o) { return c.pose_error <= um(o.pose_error_um); }},
    Interlock{Reason::pose_surprising,
              [](const C& c, const O& o) { return c.innovation <= um(o.innovation_in_pulse_um); }},
    Interlock{Reason::retina_moves,
              [](const C& c, const O& o) { return c.retina_speed <= 1e-3 * o.retina_speed_mm_s; }},
    Interlock{Reason::reach_ends, [](const C& c, const O& o) { return c.reach_left >= um(o.reach_left_um); }},
    Interlock{Reason::standoff_wrong, [](const C& c, const O& o) { return c.standoff_error <= um(o.standoff_um); }},
    Interlock{Reason::near_vessel, [](const C& c, const O& o) { return c.clearance >= um(o.clearance_um); }},
    Interlock{Reason::spot_off_target, [](const C& c, const O& o) { return c.spot_distance <= um(o.spot_um); }},
};

constexpr std::array kToBegin{
    Interlock{Reason::target_burnt, [](const C& c, const O&) { return c.target_unburnt; }},
    Interlock{Reason::pose_surprising, [](const C& c, const O& o) { return c.innovation <= um(o.innovation_um); }},
    Interlock{Reason::retina_jumped, [](const C& c, const O& o) { return c.since_jump >= ms(o.rest_after_jump_ms); }},
    Interlock{Reason::tip_moves, [](const C& c, const O& o) { return c.speed <= 1e-3 * o.speed_mm_s; }},
    Interlock{Reason::tip_unsettled,
              [](const C& c, const O& o) {
                return c.goal_distance <= um(o.settled_um) && c.settled_for >= ms(o.settled_ms);
              }},
};

template <std::size_t kCount>
Reason firstOpen(const std::array<Interlock, kCount>& interlocks, const C& now, const O& options)
{
  for (const Interlock& interlock : interlocks) {
    if (!interlock.closed(now, options)) return interlock.reason;
  }
  return Reason::none;
}

}  // namespace

Reason LaserInterlocks::whyNotBegin(const PulseConditions& now) const
{
  const Reason open = whyNotGoOn(now);
  return open != Reason::none ? open : firstOpen(kToBegin, now, options_);
}

Reason LaserInterlocks::whyNotGoOn(const PulseConditions& now) const { return firstOpen(kAlways, now, options_); }

}  // namespace eyeslam::servo
