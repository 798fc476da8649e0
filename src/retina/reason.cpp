// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/retina/reason.h"

#include <algorithm>
#include <array>

namespace eyeslam::retina {

namespace {

struct Word {
  Reason reason;
  std::string_view word;
};

// Complete and spelt like the enumerators: tests/house/reasons_test.py.
constexpr std::array kWords{
    Word{Reason::none, ""},
    Word{Reason::blackout, "blackout"},
    Word{Reason::wrong_size, "wrong_size"},
    Word{Reason::too_few_points, "too_few_points"},
    Word{Reason::ambiguous, "ambiguous"},
    Word{Reason::poor_match, "poor_match"},
    Word{Reason::searching, "searching"},
    Word{Reason::noise, "noise"},
    Word{Reason::frozen, "frozen"},
    Word{Reason::record_failed, "record_failed"},
    Word{Reason::input_not_finite, "input_not_finite"},
    Word{Reason::bad_time_step, "bad_time_step"},
    Word{Reason::retina_lost, "retina_lost"},
    Word{Reason::map_changed, "map_changed"},
    Word{Reason::no_vessel, "no_vessel"},
    Word{Reason::vessel_gone, "vessel_gone"},
    Word{Reason::vessel_end, "vessel_end"},
    Word{Reason::branch_changed, "branch_changed"},
    Word{Reason::map_updated, "map_updated"},
    Word{Reason::too_far, "too_far"},
    Word{Reason::engaging, "engaging"},
    Word{Reason::keep_out, "keep_out"},
    Word{Reason::inside_keep_out, "inside_keep_out"},
    Word{Reason::speed_limited, "speed_limited"},
    Word{Reason::out_of_reach, "out_of_reach"},
    Word{Reason::near_vessel, "near_vessel"},
    Word{Reason::near_fovea, "near_fovea"},
    Word{Reason::near_disc, "near_disc"},
    Word{Reason::in_keep_out, "in_keep_out"},
    Word{Reason::not_seen, "not_seen"},
    Word{Reason::outside_map, "outside_map"},
    Word{Reason::crowded, "crowded"},
    Word{Reason::not_registered, "not_registered"},
    Word{Reason::registration_residual, "registration_residual"},
    Word{Reason::registration_uncertain, "registration_uncertain"},
    Word{Reason::registration_drift, "registration_drift"},
    Word{Reason::registration_scale, "registration_scale"},
    Word{Reason::outlier, "outlier"},
    Word{Reason::tip_at_rest, "tip_at_rest"},
    Word{Reason::surface_unknown, "surface_unknown"},
    Word{Reason::no_state, "no_state"},
    Word{Reason::state_late, "state_late"},
    Word{Reason::state_not_finite, "state_not_finite"},
    Word{Reason::state_stale, "state_stale"},
    Word{Reason::no_pose, "no_pose"},
    Word{Reason::pose_late, "pose_late"},
    Word{Reason::pose_not_finite, "pose_not_finite"},
    Word{Reason::pose_stale, "pose_stale"},
    Word{Reason::pose_jumped, "pose_jumped"},
    Word{Reason::tip_late, "tip_late"},
    Word{Reason::tip_not_finite, "tip_not_finite"},
    Word{Reason::tip_far, "tip_far"},
    Word{Reason::goal_not_finite, "goal_not_finite"},
    Word{Reason::cycle_late, "cycle_late"},
    Word{Reason::unauthenticated, "unauthenticated"},
    Word{Reason::wrong_type, "wrong_type"},
    Word{Reason::wrong_length, "wrong_length"},
    Word{Reason::wrong_session, "wrong_session"},
    Word{Reason::replayed, "replayed"},
    Word{Reason::out_of_order, "out_of_order"},
    Word{Reason::expired, "expired"},
    Word{Reason::clock_stepped, "clock_stepped"},
    Word{Reason::clock_differs, "clock_differs"},
    Word{Reason::not_finite, "not_finite"},
    Word{Reason::out_of_range, "out_of_range"},
    Word{Reason::internal_error, "internal_error"},
    Word{Reason::asked, "asked"},
    Word{Reason::stopped, "stopped"},
    Word{Reason::operator_stale, "operator_stale"},
    Word{Reason::laser_stale, "laser_stale"},
    Word{Reason::not_in_laser, "not_in_laser"},
    Word{Reason::foot_switch_up, "foot_switch_up"},
    Word{Reason::not_armed, "not_armed"},
    Word{Reason::interlock_open, "interlock_open"},
    Word{Reason::plan_not_in_force, "plan_not_in_force"},
    Word{Reason::target_invalid, "target_invalid"},
    Word{Reason::target_burnt, "target_burnt"},
    Word{Reason::pose_uncertain, "pose_uncertain"},
    Word{Reason::pose_surprising, "pose_surprising"},
    Word{Reason::retina_moves, "retina_moves"},
    Word{Reason::retina_jumped, "retina_jumped"},
    Word{Reason::reach_ends, "reach_ends"},
    Word{Reason::standoff_wrong, "standoff_wrong"},
    Word{Reason::spot_off_target, "spot_off_target"},
    Word{Reason::tip_moves, "tip_moves"},
    Word{Reason::tip_unsettled, "tip_unsettled"},
    Word{Reason::out_of_view, "out_of_view"},
    Word{Reason::unpowered, "unpowered"},
    Word{Reason::controller_restarted, "controller_restarted"},
    Word{Reason::rival_servo, "rival_servo"},
    Word{Reason::vessel_unknown, "vessel_unknown"},
    Word{Reason::zone_invalid, "zone_invalid"},
    Word{Reason::scale_unknown, "scale_unknown"},
    Word{Reason::plan_scale, "plan_scale"},
    Word{Reason::plan_done, "plan_done"},
    Word{Reason::pulse_unconfirmed, "pulse_unconfirmed"},
    Word{Reason::pulse_refused, "pulse_refused"},
    Word{Reason::pulse_cut, "pulse_cut"},
    Word{Reason::pose_not_new, "pose_not_new"},
    Word{Reason::burns_full, "burns_full"},
    Word{Reason::approaching, "approaching"},
    Word{Reason::beam_misses, "beam_misses"},
    Word{Reason::no_tip, "no_tip"},
    Word{Reason::no_command, "no_command"},
    Word{Reason::other_mode, "other_mode"},
    Word{Reason::not_powered, "not_powered"},
    Word{Reason::pulse_too_long, "pulse_too_long"},
    Word{Reason::power_too_high, "power_too_high"},
    Word{Reason::command_lapsed, "command_lapsed"},
    Word{Reason::servo_singular, "servo_singular"},
};

}  // namespace

std::string_view word(Reason reason)
{
  const auto* const found =
      std::find_if(kWords.begin(), kWords.end(), [reason](const Word& entry) { return entry.reason == reason; });
  return found == kWords.end() ? "unknown" : found->word;
}

}  // namespace eyeslam::retina
