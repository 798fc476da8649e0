// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/micron_controller.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "eyeslam/retina/smoothstep.h"
#include "eyeslam/retina/turn_between.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/shortened.h"

namespace eyeslam::simulation {

using messaging::GoalReference;
using messaging::MicronCommand;
using messaging::MicronMode;
using retina::Reason;

namespace {

constexpr double kNear = 100e-6;  // m: what the tip is behind a goal at 20 mm/s, by the plant's lead

double distanceFromLine(const Eigen::Vector3d& point, const Eigen::Vector3d& on_line, const Eigen::Vector3d& direction)
{
  return (point - on_line).cross(direction).norm();
}

}  // namespace

MicronController::MicronController(const MicronControllerOptions& options, const Eigen::Isometry3d& manipulator_T_world,
                                   std::uint64_t seed, double period_s)
    : options_(options),
      manipulator_T_world_(manipulator_T_world),
      period_s_(period_s),
      tip_(options.plant, seed, period_s),
      pivot_(options.pivot, options.plant, options.ramp_ms * kMilli, options.own_speed_mm_s * kMilli, seed, period_s),
      filter_(options.filter, period_s),
      ramp_s_(options.ramp_ms * kMilli)
{
  state_.abilities = {tip_.lead(),    options.plant.reach_mm * kMilli,   options.plant.reach_axial_mm * kMilli,
                      1.0 / period_s, options.plant.speed_mm_s * kMilli, options.plant.acceleration_m_s2};
  state_.pose_measured = true;
  state_.port_measured = options.port_measured;
}

std::int64_t MicronController::stateAge_us() const
{
  const double periods = std::round(options_.plant.state_age_ms * kMilli / period_s_);
  return std::llround(1e6 * period_s_ * periods);
}

Eigen::Vector3d MicronController::shaft() const { return (pivot_.point() - tip_.tip()).normalized(); }

double MicronController::pivotError() const
{
  return pivot_.isAsked() ? distanceFromLine(pivot_.pivot(), tip_.tip(), shaft()) : 0.0;
}

MicronController::Source MicronController::chosen(const HeardCommand<MicronCommand>& heard)
{
  state_.reason = heard.whyNotInForce(options_.expiry_ms * kMilli);
  if (!powered_) state_.reason = Reason::not_powered;
  if (state_.reason == Reason::none && heard.command->mode != MicronMode::follow) state_.reason = Reason::other_mode;
  if (!powered_) return Source::no_power;
  if (state_.reason == Reason::none) {
    return heard.command->reference == GoalReference::tip ? Source::tip_goal : Source::deflection;
  }
  const bool at_null = state_.reason == Reason::other_mode && heard.command->mode == MicronMode::at_null;
  return at_null ? Source::at_null : Source::own_filter;
}

// From the goal before, or from near the tip where that is still far behind its goal.
void MicronController::change(Source source)
{
  if (source == source_) return;
  source_ = source;
  const Eigen::Vector3d& tip = tip_.fresh().tip;
  from_ = tip + shortened(goal_ - tip, kNear);
  ramp_s_ = 0.0;
}

// How far the ramp from the source before has come, [0, 1].
double MicronController::ramp()
{
  ramp_s_ += period_s_;
  return options_.ramp_ms > 0.0 ? retina::smoothstep(ramp_s_ / (options_.ramp_ms * kMilli)) : 1.0;
}

void MicronController::followGoal(const Eigen::Vector3d& wanted)
{
  goal_ = from_ + ramp() * (wanted - from_);
  deflection_ = goal_ - null_;
}

void MicronController::followDeflection(const Eigen::Vector3d& wanted)
{
  deflection_ = wanted + (1.0 - ramp()) * (from_ - null_ - wanted);
  goal_ = null_ + deflection_;
}

void MicronController::steer(const MicronCommand* command)
{
  const Eigen::Vector3d calm_hand = filter_.step(null_);
  switch (source_) {
    case Source::at_null:
      return followDeflection(Eigen::Vector3d::Zero());
    case Source::own_filter:
      return followGoal(calm_hand);
    case Source::tip_goal:
      return followGoal(manipulator_T_world_.inverse() * command->goal);
    case Source::deflection:
      return followDeflection(manipulator_T_world_.linear().transpose() * command->goal);
    case Source::no_power:
      goal_ = null_ + deflection_;
      return;
  }
}

void MicronController::begin(const HeldManipulator& held)
{
  filter_.hold(held.null);
  goal_ = from_ = calm_null_ = held.null;
  way_ = manipulator_T_world_.linear() * -held.shaft;
  started_ = true;
}

const messaging::MicronState& MicronController::step(const HeldManipulator& held,
                                                     const HeardCommand<MicronCommand>& heard)
{
  // Before the first measurement it has nothing but the hand itself.
  null_ = started_ ? tip_.fresh().null : held.null;
  const Source source = chosen(heard);
  if (started_) {
    change(source);
  } else {
    begin(held);
    if (source != source_) ramp_s_ = 0.0;
    source_ = source;
  }
  steer(heard.command);
  move(held, heard);
  report(heard);
  return state_;
}

void MicronController::move(const HeldManipulator& held, const HeardCommand<MicronCommand>& heard)
{
  const double eased = options_.calm_ms > 0.0 ? 1.0 - std::exp(-period_s_ / (options_.calm_ms * kMilli)) : 1.0;
  const Eigen::Vector3d hand_step = eased * (null_ - calm_null_);
  calm_null_ += hand_step;
  const bool follows = source_ == Source::tip_goal || source_ == Source::deflection;
  const double speed = follows ? heard.command->speed_bound : options_.own_speed_mm_s * kMilli;
  tip_.boundSpeed(speed, hand_step / period_s_);
  pivot_.boundSpeed(speed, hand_step / period_s_);
  tip_.commandDeflection(deflection_);
  tip_.setShaft(held.shaft);
  tip_.step(held.null, held.port);
  if (!powered_) return pivot_.stepUnpowered(held.null, held.shaft);
  const bool commanded = state_.reason == Reason::none || state_.reason == Reason::other_mode;
  std::optional<Eigen::Vector3d> pivot;
  if (commanded && heard.command->keep_pivot) pivot = manipulator_T_world_.inverse() * heard.command->pivot;
  pivot_.step(held.null, held.shaft, deflection_, pivot);
}

messaging::ToolPose MicronController::toolPose(const Eigen::Vector3d& tip, const Eigen::Vector3d& up,
                                               double along) const
{
  const Eigen::Vector3d shaft = (up - tip).normalized();
  const Eigen::Quaterniond first = retina::turnBetween(Eigen::Vector3d::UnitZ(), way_);
  messaging::ToolPose pose;
  pose.position = manipulator_T_world_ * (tip + along * shaft);
  pose.orientation = (retina::turnBetween(way_, manipulator_T_world_.linear() * -shaft) * first).normalized();
  return pose;
}

void MicronController::report(const HeardCommand<MicronCommand>& heard)
{
  const MicronReading& tip = tip_.state();
  const MicronReading& up = pivot_.reading();
  state_.null = toolPose(tip.null, up.null, 0.0);
  state_.tip = toolPose(tip.tip, up.tip, 0.0);
  state_.handle = toolPose(tip.null, up.null, options_.handle_mm * kMilli);
  const bool follows = source_ == Source::tip_goal || source_ == Source::deflection;
  state_.goal = follows ? manipulator_T_world_ * goal_ : state_.null.position;
  if (options_.port_measured) {
    state_.port_displacement = manipulator_T_world_.linear() * Eigen::Vector3d(tip.port.x(), tip.port.y(), 0.0);
  }
  const MicronLimits& limits = tip_.limits();
  const bool off_pivot = pivot_.isAsked() && pivot_.isThere() && pivotError() > options_.pivot.tolerance_um * kMicro;
  state_.limits = {limits.lateral, limits.axial, limits.speed, limits.acceleration, pivot_.isLimited() || off_pivot};
  state_.powered = powered_;
  state_.cancels_tremor = source_ == Source::own_filter;
  state_.follows_command = follows;
  state_.keeps_pivot = pivot_.isAsked() && pivot_.isThere() && !state_.limits.pivot;
  state_.command_session = heard.session;
  state_.command_seq = heard.seq;
  state_.commands_refused = heard.refused;
}

}  // namespace eyeslam::simulation
