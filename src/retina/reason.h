// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string_view>

namespace eyeslam::retina {

/// Why something was refused: one list for files (the word) and messages (the number). Numbers never change meaning.
enum class Reason : std::int16_t {
  none = 0,
  // Tracking
  blackout = 1,        ///< hardly any retina in view: too dark, or covered
  wrong_size = 2,      ///< the frame's size or type differs from the first frame's
  too_few_points = 3,  ///< not enough vessel points to match
  ambiguous = 4,       ///< two places fit alike
  poor_match = 5,      ///< nothing in the map fits
  // 6 is free: it was never given
  searching = 7,       ///< lost; the search of the whole map goes on in the next frame
  noise = 8,           ///< the picture is noise, so no map is started from it
  frozen = 9,          ///< a live picture is the last one again
  record_failed = 10,  ///< the recording cannot be written (disk full): vision has stopped
  // Fixtures: what stands between the hand and its goal
  input_not_finite = 20,  ///< an input was not a finite, plausible number, or a pose not rigid
  bad_time_step = 21,     ///< the time since the last cycle was not positive
  retina_lost = 22,       ///< where the retina is, is not known
  map_changed = 23,       ///< the pose belongs to another map than the fixtures
  no_vessel = 24,         ///< none near enough to follow
  vessel_gone = 25,       ///< the one that was followed is not in the newer map
  vessel_end = 26,        ///< held at a free end
  branch_changed = 27,    ///< on the way to another vessel that does not meet the last one
  map_updated = 28,       ///< on the way to where the newer map has the vessel
  too_far = 29,           ///< the hand has left the vessel
  engaging = 30,          ///< on the way to a fixture that has just come into force
  keep_out = 31,          ///< stopped or turned aside by a region that must not be entered
  inside_keep_out = 32,   ///< such a region came over the goal, which leaves it
  speed_limited = 33,     ///< the goal lags behind what is wanted
  out_of_reach = 34,      ///< what is wanted is farther from the null than the manipulator reaches
  // Burn planning: why a target must not be burnt
  near_vessel = 40,  ///< margin and localization error reach a vessel
  near_fovea = 41,   ///< or the zone around the fovea
  near_disc = 42,    ///< or the zone around the optic disc
  in_keep_out = 43,  ///< or a drawn zone
  not_seen = 44,     ///< or a place seen in too few frames to know that there is no vessel
  outside_map = 45,  ///< or the end of the map
  crowded = 46,      ///< nearer to another target than the pattern's spacing
  // Registration between camera and manipulator
  not_registered = 110,          ///< too few tips seen yet
  registration_residual = 111,   ///< tips lie too far from the fit
  registration_uncertain = 112,  ///< the tips seen do not fix it well enough
  registration_drift = 113,      ///< the newest tips lie all on one side
  registration_scale = 114,      ///< its um per px differs from the declared one
  outlier = 115,                 ///< too far from what is expected
  tip_at_rest = 116,             ///< brings nothing new
  surface_unknown = 117,         ///< the swept points lie on no plane
  // Servo: inputs and steps of the 1 kHz loop
  no_state = 90,          ///< no state of the manipulator has come yet
  state_late = 91,        ///< a state not younger than the last one, or from the future
  state_not_finite = 92,  ///< a state with a number that is none
  state_stale = 93,       ///< the newest state is too old
  no_pose = 94,           ///< the retina has not been seen yet
  pose_late = 95,         ///< a pose not younger than the last one, from the future, or older than the history kept
  pose_not_finite = 96,   ///< a pose with a number that is none
  pose_stale = 97,        ///< the newest pose is too old
  pose_jumped = 98,       ///< the pose was taken, but as a jump: its speed was forgotten
  tip_late = 99,          ///< a tip seen not later than the last one, or outside the history kept
  tip_not_finite = 100,   ///< a tip seen with a number that is none
  tip_far = 101,          ///< the tip was seen too far from where the registration puts it
  goal_not_finite = 102,  ///< a goal with a number that is none
  cycle_late = 103,       ///< a cycle whose time does not follow the last one's
  // Messages
  unauthenticated = 60,  ///< no tag of a holder of the key for this channel
  wrong_type = 61,       ///< another type than the channel's
  wrong_length = 62,     ///< too short, too long, or a count in it is
  wrong_session = 63,    ///< not from the sender first heard; a human decides on another
  replayed = 64,         ///< its number was there before, or is too old to tell
  out_of_order = 65,     ///< overtaken by a later one
  expired = 66,          ///< too long under way to be obeyed
  clock_stepped = 67,    ///< the sender's clock jumped against the receiver's
  clock_differs = 68,    ///< a first message whose sender's time is not the receiver's
  not_finite = 69,       ///< NaN or infinity in a message
  out_of_range = 70,     ///< a value that the field cannot have
  internal_error = 71,   ///< an exception in the receiving program
  // Supervisor and laser interlocks
  asked = 120,              ///< a human wants it so
  stopped = 121,            ///< a human stopped it
  operator_stale = 122,     ///< nothing was heard from the human for too long
  laser_stale = 123,        ///< nothing was heard from the laser for too long
  not_in_laser = 125,       ///< the servo is in another state
  foot_switch_up = 126,     ///< not pressed
  not_armed = 127,          ///< by the human, or at the laser itself
  interlock_open = 128,     ///< the remote interlock
  plan_not_in_force = 129,  ///< not approved, or changed since
  target_invalid = 130,     ///< in the newest map
  target_burnt = 131,       ///< already
  pose_uncertain = 132,     ///< its error may be too large
  pose_surprising = 133,    ///< not where it was expected
  retina_moves = 134,       ///< too fast
  retina_jumped = 135,      ///< a moment ago
  reach_ends = 136,         ///< the manipulator is near its limit
  standoff_wrong = 137,     ///< too near the retina, or too far
  spot_off_target = 138,    ///< in the newest frame
  tip_moves = 139,          ///< too fast
  tip_unsettled = 140,      ///< not long enough at its goal
  out_of_view = 141,        ///< the picture does not show the place
  // The servo behind its messages
  unpowered = 150,             ///< the manipulator's actuators are off
  controller_restarted = 151,  ///< another session speaks for the manipulator
  rival_servo = 152,           ///< another servo commands the same manipulator or laser
  vessel_unknown = 153,        ///< the map has no vessel of this id
  zone_invalid = 154,          ///< a zone that cannot be kept out of
  scale_unknown = 155,         ///< no um per px, or more than one
  // Burning a plan
  plan_scale = 160,         ///< its um per px differs from the retina's
  plan_done = 161,          ///< no target is left that may be burnt
  pulse_unconfirmed = 162,  ///< the laser has not said yet what became of the last pulse
  pulse_refused = 163,      ///< the laser did not begin it
  pulse_cut = 164,          ///< it ended early
  pose_not_new = 165,       ///< a pulse begins right after a pose alone
  burns_full = 166,         ///< no room left to remember what was burnt
  approaching = 167,        ///< the way to the target, or the dwell at it, is not over
  beam_misses = 168,        ///< the beam does not meet the retina, or tip and shaft are not known
  no_tip = 169,             ///< none was seen in the frame
  // Devices: why a command moves nothing or emits nothing
  no_command = 170,      ///< none has come yet
  other_mode = 171,      ///< the command asks for the null, or for the controller's own tremor filter
  not_powered = 172,     ///< the motors
  pulse_too_long = 173,  ///< for this laser
  power_too_high = 174,  ///< for this laser
  command_lapsed = 175,  ///< a pulse was no longer held, so it ended early
  // Visual servoing
  servo_singular = 185,  ///< the features do not fix the motion of the tip
};

/// The word of a reason, as in `trajectory.csv`; empty for `none`.
std::string_view word(Reason reason);

}  // namespace eyeslam::retina
