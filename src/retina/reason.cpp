// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/retina/reason.h"

#include <algorithm>
#include <iterator>

namespace eyeslam::retina {
namespace {

struct Word {
  Reason reason;
  std::string_view word;
};

// Every reason once, in the order of reason.h: tests/house checks it.
constexpr Word kWords[] = {
    {Reason::none, ""},
    {Reason::blackout, "blackout"},
    {Reason::wrong_size, "wrong_size"},
    {Reason::too_few_points, "too_few_points"},
    {Reason::ambiguous, "ambiguous"},
    {Reason::poor_match, "poor_match"},
    {Reason::searching, "searching"},
    {Reason::noise, "noise"},
    {Reason::input_not_finite, "input_not_finite"},
    {Reason::bad_time_step, "bad_time_step"},
    {Reason::retina_lost, "retina_lost"},
    {Reason::map_changed, "map_changed"},
    {Reason::no_vessel, "no_vessel"},
    {Reason::vessel_gone, "vessel_gone"},
    {Reason::vessel_end, "vessel_end"},
    {Reason::branch_changed, "branch_changed"},
    {Reason::map_updated, "map_updated"},
    {Reason::too_far, "too_far"},
    {Reason::engaging, "engaging"},
    {Reason::keep_out, "keep_out"},
    {Reason::inside_keep_out, "inside_keep_out"},
    {Reason::speed_limited, "speed_limited"},
    {Reason::out_of_reach, "out_of_reach"},
    {Reason::near_vessel, "near_vessel"},
    {Reason::near_fovea, "near_fovea"},
    {Reason::near_disc, "near_disc"},
    {Reason::in_keep_out, "in_keep_out"},
    {Reason::not_seen, "not_seen"},
    {Reason::outside_map, "outside_map"},
    {Reason::crowded, "crowded"},
    {Reason::not_registered, "not_registered"},
    {Reason::registration_residual, "registration_residual"},
    {Reason::registration_uncertain, "registration_uncertain"},
    {Reason::registration_drift, "registration_drift"},
    {Reason::registration_scale, "registration_scale"},
    {Reason::outlier, "outlier"},
    {Reason::tip_at_rest, "tip_at_rest"},
    {Reason::surface_unknown, "surface_unknown"},
    {Reason::no_state, "no_state"},
    {Reason::state_late, "state_late"},
    {Reason::state_not_finite, "state_not_finite"},
    {Reason::state_stale, "state_stale"},
    {Reason::no_pose, "no_pose"},
    {Reason::pose_late, "pose_late"},
    {Reason::pose_not_finite, "pose_not_finite"},
    {Reason::pose_stale, "pose_stale"},
    {Reason::pose_jumped, "pose_jumped"},
    {Reason::tip_late, "tip_late"},
    {Reason::tip_not_finite, "tip_not_finite"},
    {Reason::tip_far, "tip_far"},
    {Reason::goal_not_finite, "goal_not_finite"},
    {Reason::cycle_late, "cycle_late"},
    {Reason::unauthenticated, "unauthenticated"},
    {Reason::wrong_type, "wrong_type"},
    {Reason::wrong_length, "wrong_length"},
    {Reason::wrong_session, "wrong_session"},
    {Reason::replayed, "replayed"},
    {Reason::out_of_order, "out_of_order"},
    {Reason::expired, "expired"},
    {Reason::clock_stepped, "clock_stepped"},
    {Reason::clock_differs, "clock_differs"},
    {Reason::not_finite, "not_finite"},
    {Reason::out_of_range, "out_of_range"},
    {Reason::internal_error, "internal_error"},
    {Reason::asked, "asked"},
    {Reason::stopped, "stopped"},
    {Reason::operator_stale, "operator_stale"},
    {Reason::laser_stale, "laser_stale"},
    {Reason::not_in_laser, "not_in_laser"},
    {Reason::foot_switch_up, "foot_switch_up"},
    {Reason::not_armed, "not_armed"},
    {Reason::interlock_open, "interlock_open"},
    {Reason::plan_not_in_force, "plan_not_in_force"},
    {Reason::target_invalid, "target_invalid"},
    {Reason::target_burnt, "target_burnt"},
    {Reason::pose_uncertain, "pose_uncertain"},
    {Reason::pose_surprising, "pose_surprising"},
    {Reason::retina_moves, "retina_moves"},
    {Reason::retina_jumped, "retina_jumped"},
    {Reason::reach_ends, "reach_ends"},
    {Reason::standoff_wrong, "standoff_wrong"},
    {Reason::spot_off_target, "spot_off_target"},
    {Reason::tip_moves, "tip_moves"},
    {Reason::tip_unsettled, "tip_unsettled"},
};

}  // namespace

std::string_view word(Reason reason)
{
  const auto* const found =
      std::find_if(std::begin(kWords), std::end(kWords), [reason](const Word& word) { return word.reason == reason; });
  return found == std::end(kWords) ? "unknown" : found->word;
}

}  // namespace eyeslam::retina
