// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/servo/burn_ledger.h"
#include "eyeslam/servo/burn_run_options.h"
#include "eyeslam/servo/laser_interlocks.h"
#include "eyeslam/servo/motion_limiter.h"
#include "eyeslam/servo/preparation.h"
#include "eyeslam/servo/pulse_watch.h"
#include "eyeslam/servo/spot_aim.h"
#include "eyeslam/servo/timed_ring.h"
#include "eyeslam/servo/unknown.h"
#include "eyeslam/servo/view_pose.h"

namespace eyeslam::servo {

/// What one cycle knows. Places are in the retina frame (m, z into the retina); ages and durations in s. Everything
/// starts as what forbids a pulse.
struct BurnInput {
  std::int64_t now = 0;  ///< us, of the cycle
  double step_s = 0.0;   ///< since the last cycle

  // Who allows it
  bool laser_state = false;                       ///< the supervisor is in Laser
  const messaging::OperatorWish* wish = nullptr;  ///< null before the first
  double operator_age = kUnknown;
  const messaging::LaserState* laser = nullptr;  ///< null before the first
  double laser_age = kUnknown;                   ///< since it was received

  // What the picture and the map are worth
  const Preparation* preparation = nullptr;
  std::int64_t map_id = 0;  ///< of the newest pose
  bool registered = false;
  double um_per_px = 0.0;  ///< the registration's own; 0 = unknown
  bool tracked = false;    ///< the newest frame
  std::int64_t pose_utime = 0;
  double pose_age = kUnknown;    ///< since the middle of its exposure
  double since_pose = kUnknown;  ///< since it came
  double pose_error = kUnknown;  ///< m, 95 %, at the tip
  double innovation = kUnknown;  ///< m, of the newest pose
  double since_jump = 0.0;
  double retina_speed = kUnknown;  ///< m/s

  // Where the instrument is
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();    ///< measured
  Eigen::Vector3d shaft = Eigen::Vector3d::Zero();  ///< unit, towards the tip and so along the beam
  std::int64_t tip_utime = 0;                       ///< of both
  Eigen::Vector3d null = Eigen::Vector3d::Zero();   ///< of the hand
  double reach = 0.0;                               ///< m, largest deflection
  double reach_left = 0.0;                          ///< m, of the present one
  std::int64_t sight_utime = 0;                     ///< mid-exposure of the newest frame that was searched for a spot
  std::optional<Eigen::Vector2d> spot;              ///< of the aiming beam in that frame, by that frame's pose
  ViewPose view;                                    ///< of this instant
  Eigen::Vector2d view_size = Eigen::Vector2d::Zero();  ///< of the picture, m
};

struct BurnOutput {
  std::optional<Eigen::Vector3d> goal;           ///< of the tip, retina frame; none: no target to go to
  messaging::LaserCommand command;               ///< to be sent every cycle
  retina::Reason reason = retina::Reason::none;  ///< why there is no pulse now; none while one is asked for
  int target = -1;                               ///< id; -1: none
};

/// The state Laser: goes to one target of the plan after the other, in its order, holds the beam on it, and asks for
/// one pulse where every interlock is closed. What is invalid in the newest map, out of the hand's reach, out of the
/// picture, in a zone or already burnt is passed over. A pulse counts when the laser has said how long it was; until
/// then there is no other. One that was cut is recorded and not repeated. To be called in every cycle, whatever the
/// state, so that the fate of a pulse is always learnt. No clock, no message. Never throws, never allocates. Source:
/// loop study, sections 2.8, 5.
///
///   const BurnOutput& out = run.step(input);
///   if (out.goal) fixture_goal = *out.goal;
///   laser_commands.publish(out.command, ...);
class BurnRun {
 public:
  explicit BurnRun(const BurnRunOptions& options = {});

  const BurnOutput& step(const BurnInput& input) noexcept;

  /// Why the proposed plan is not executed; none when it is in force.
  retina::Reason planReason() const noexcept { return plan_reason_; }
  const BurnLedger& ledger() const noexcept { return ledger_; }
  /// What the interlocks judged last.
  const PulseConditions& conditions() const noexcept { return conditions_; }
  /// How far the spot is seen from where tip and shaft put it; retina frame, m.
  const Eigen::Vector2d& spotCorrection() const noexcept { return aim_.correction(); }

 private:
  retina::Reason whyNotInForce(const BurnInput& input) const noexcept;
  void takePlan(const BurnInput& input) noexcept;
  void rest() noexcept;
  void observe(const BurnInput& input) noexcept;
  void seeSpot(const BurnInput& input) noexcept;
  bool isAimed(const BurnInput& input) const noexcept;
  void followPulse(const BurnInput& input) noexcept;

  void choose(const BurnInput& input) noexcept;
  void lookAt(const BurnInput& input) noexcept;
  retina::Reason whyNotTarget(std::size_t index, const BurnInput& input) const noexcept;
  retina::Reason whyZoned(std::size_t index, const BurnInput& input) const noexcept;
  bool isBurntAlready(std::size_t index, const Preparation& preparation) const noexcept;
  bool isInView(const Eigen::Vector3d& place, const BurnInput& input) const noexcept;
  retina::Reason whyNotNow(std::size_t index, const BurnInput& input) const noexcept;

  void approach(const BurnInput& input) noexcept;
  double speed() const noexcept;
  double spotDistance(const BurnInput& input, const Eigen::Vector2d& place) const noexcept;
  void judge(const BurnInput& input) noexcept;
  void judgeTarget(const BurnInput& input) noexcept;
  retina::Reason whyNotFire(const BurnInput& input) const noexcept;
  void fire(const BurnInput& input) noexcept;

  BurnRunOptions options_;
  LaserInterlocks interlocks_;
  BurnLedger ledger_;
  PulseWatch pulse_;
  SpotAim aim_;
  MotionLimiter travel_;
  TimedRing<Eigen::Vector3d, 16> tips_;
  retina::Reason plan_reason_ = retina::Reason::plan_not_in_force;
  std::int64_t map_id_ = 0;

  std::optional<std::size_t> target_;                       // index in the plan
  std::size_t scan_ = 0;                                    // where the search for a target goes on
  retina::Reason passed_over_ = retina::Reason::plan_done;  // what this search has found so far
  retina::Reason last_scan_ = retina::Reason::approaching;  // what the last whole one found
  bool travelling_ = false;                                 // travel_ stands somewhere
  double dwelt_s_ = 0.0, settled_s_ = 0.0, waited_s_ = 0.0;

  std::int64_t sight_utime_ = 0;
  std::optional<Eigen::Vector2d> spot_;             // in that frame
  std::int64_t pulse_from_ = 0, pulse_until_ = -1;  // us, of the last pulse asked for
  std::int64_t pulse_map_id_ = 0;
  Eigen::Vector2d pulse_place_px_ = Eigen::Vector2d::Zero();

  PulseConditions conditions_;
  BurnOutput output_;
};

}  // namespace eyeslam::servo
