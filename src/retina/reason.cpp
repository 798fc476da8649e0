// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/retina/reason.h"

namespace eyeslam::retina {

std::string_view word(Reason reason)
{
  switch (reason) {
    case Reason::none:
      return "";
    case Reason::blackout:
      return "blackout";
    case Reason::wrong_size:
      return "wrong_size";
    case Reason::too_few_points:
      return "too_few_points";
    case Reason::ambiguous:
      return "ambiguous";
    case Reason::poor_match:
      return "poor_match";
    case Reason::blurred:
      return "blurred";
    case Reason::searching:
      return "searching";
    case Reason::near_vessel:
      return "near_vessel";
    case Reason::near_fovea:
      return "near_fovea";
    case Reason::near_disc:
      return "near_disc";
    case Reason::in_keep_out:
      return "in_keep_out";
    case Reason::not_seen:
      return "not_seen";
    case Reason::outside_map:
      return "outside_map";
    case Reason::crowded:
      return "crowded";
    case Reason::not_finite:
      return "not_finite";
    case Reason::not_registered:
      return "not_registered";
    case Reason::registration_residual:
      return "registration_residual";
    case Reason::registration_uncertain:
      return "registration_uncertain";
    case Reason::registration_drift:
      return "registration_drift";
    case Reason::registration_scale:
      return "registration_scale";
    case Reason::outlier:
      return "outlier";
    case Reason::tip_at_rest:
      return "tip_at_rest";
    case Reason::surface_unknown:
      return "surface_unknown";
    case Reason::no_state:
      return "no_state";
    case Reason::state_late:
      return "state_late";
    case Reason::state_not_finite:
      return "state_not_finite";
    case Reason::state_stale:
      return "state_stale";
    case Reason::no_pose:
      return "no_pose";
    case Reason::pose_late:
      return "pose_late";
    case Reason::pose_not_finite:
      return "pose_not_finite";
    case Reason::pose_stale:
      return "pose_stale";
    case Reason::pose_jumped:
      return "pose_jumped";
    case Reason::tip_late:
      return "tip_late";
    case Reason::tip_not_finite:
      return "tip_not_finite";
    case Reason::tip_far:
      return "tip_far";
    case Reason::goal_not_finite:
      return "goal_not_finite";
    case Reason::cycle_late:
      return "cycle_late";
    case Reason::unauthenticated:
      return "unauthenticated";
    case Reason::wrong_type:
      return "wrong_type";
    case Reason::wrong_length:
      return "wrong_length";
    case Reason::wrong_session:
      return "wrong_session";
    case Reason::replayed:
      return "replayed";
    case Reason::out_of_order:
      return "out_of_order";
    case Reason::expired:
      return "expired";
    case Reason::clock_stepped:
      return "clock_stepped";
    case Reason::clock_differs:
      return "clock_differs";
    case Reason::out_of_range:
      return "out_of_range";
    case Reason::internal_error:
      return "internal_error";
  }
  return "unknown";
}

}  // namespace eyeslam::retina
