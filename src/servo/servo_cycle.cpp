// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/servo_cycle.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"
#include "eyeslam/servo/loop_time.h"

namespace eyeslam::servo {

using retina::Reason;

ServoCycle::ServoCycle(const ServoCycleOptions& options, const ViewPlacement& placement)
    : options_(options),
      placement_(placement),
      view_T_manipulator_(placement.manipulator_T_view.inverse()),
      hand_(options.hand),
      retina_(options.retina),
      trim_(options.trim, placement.centre),
      integral_(options.integral),
      limiter_(options.limits),
      plant_(options.plant),
      hand_filter_(options.hand_filter),
      trust_(options.hand_over),
      null_at_controller_(options.null_at == "controller")
{
  setLead(options.lead_ms * kMilli);
  outlook_.reason = Reason::no_state;
}

void ServoCycle::setLead(double lead_s) noexcept
{
  lead_ = microseconds(std::max(0.0, lead_s - plant_.plantLead() + plant_.lead()));
}

Eigen::Vector3d ServoCycle::toView(const Eigen::Vector3d& manipulator) const noexcept
{
  Eigen::Vector3d view = view_T_manipulator_ * manipulator;
  if (options_.trims) view.head<2>() = trim_.toSeen(view.head<2>());
  return view;
}

Eigen::Vector3d ServoCycle::toManipulator(const Eigen::Vector3d& view) const noexcept
{
  Eigen::Vector3d measured = view;
  if (options_.trims) measured.head<2>() = trim_.toMeasured(view.head<2>());
  return placement_.manipulator_T_view * measured;
}

Eigen::Vector3d ServoCycle::onRetina(const Eigen::Vector3d& place, std::int64_t utime) const noexcept
{
  return ViewPose{placement_.centre, retina_.at(utime).view_T_retina}.toRetina(toView(place));
}

Eigen::Vector3d ServoCycle::directionOnRetina(const Eigen::Vector3d& direction, std::int64_t utime) const noexcept
{
  Eigen::Vector3d turned = view_T_manipulator_.linear() * direction;
  turned.head<2>() = Eigen::Rotation2Dd(-retina_.at(utime).view_T_retina.theta) * turned.head<2>();
  return turned.normalized();
}

Eigen::Vector3d ServoCycle::nullAt(std::int64_t utime) const noexcept
{
  return options_.predicts_null ? hand_.at(utime) : state_->null;
}

void ServoCycle::take(const ManipulatorState& state) noexcept
{
  if (!state.tip.allFinite() || !state.null.allFinite()) return refusals_.count(Reason::state_not_finite);
  if (state.utime > now_) return refusals_.count(Reason::state_late);
  const Reason refused = hand_.correct(state.utime, state.null);
  refusals_.count(refused);
  if (refused != Reason::none) return;
  if (state_ && seconds(state.utime - state_->utime) > options_.state_limit_ms * kMilli) hand_filter_.reset(state.null);
  if (state.port) refusals_.count(retina_.observePort(state.utime, *state.port));
  refusals_.count(trim_.observe(state.utime, (view_T_manipulator_ * state.tip).head<2>()));
  if (state_ && goals_.covers(state.utime) && !command_.saturated)
    integral_.update(goals_.at(state.utime) - state.tip, seconds(state.utime - state_->utime));
  state_ = state;
}

void ServoCycle::take(const SeenTip& tip) noexcept
{
  if (options_.trims) refusals_.count(trim_.correct(tip));
}

Reason ServoCycle::whatIsMissing(std::int64_t now) const noexcept
{
  if (!state_) return Reason::no_state;
  if (seconds(now - state_->utime) > options_.state_limit_ms * kMilli) return Reason::state_stale;
  if (!retina_.isReady()) return Reason::no_pose;
  if (seconds(now - retina_.utime()) > options_.pose_limit_ms * kMilli) return Reason::pose_stale;
  return Reason::none;
}

const Outlook& ServoCycle::observe(const CycleInput& input) noexcept
{
  if (now_ != 0 && input.now <= now_) {
    refusals_.count(Reason::cycle_late);
    outlook_.step_s = 0.0;
    return outlook_;
  }
  outlook_.step_s = now_ == 0 ? 0.0 : seconds(input.now - now_);
  now_ = input.now;
  if (input.state) take(*input.state);
  if (input.pose) refusals_.count(retina_.correct(*input.pose, now_));
  if (input.tip) take(*input.tip);
  outlook_.utime = now_ + lead_;
  outlook_.reason = whatIsMissing(now_);
  outlook_.prediction = retina_.at(outlook_.utime);
  outlook_.retina = {placement_.centre, outlook_.prediction.view_T_retina};
  if (state_) {
    outlook_.state_age_s = seconds(now_ - state_->utime);
    outlook_.null_retina = outlook_.retina.toRetina(toView(nullAt(outlook_.utime)));
    followHand();
  }
  return outlook_;
}

void ServoCycle::followHand() noexcept
{
  const Eigen::Vector3d null = nullAt(outlook_.utime);
  if (!null.allFinite()) return;
  outlook_.hand = hand_filter_.filter(null, outlook_.step_s);
  if (!outlook_.hand.allFinite()) hand_filter_.reset(null);
}

void ServoCycle::setPlacement(const ViewPlacement& placement) noexcept
{
  if (!placement.manipulator_T_view.matrix().allFinite()) return;
  const Eigen::Affine3d view_T_manipulator = placement.manipulator_T_view.inverse();
  if (!view_T_manipulator.matrix().allFinite()) return;
  // Where the tip works now: a line of sight at an angle makes the change depend on the height.
  const double height = state_ ? (view_T_manipulator_ * state_->tip).z() : 0.0;
  const Eigen::Affine3d change = view_T_manipulator * placement_.manipulator_T_view;
  Eigen::Affine2d new_T_old;
  new_T_old.linear() = change.linear().topLeftCorner<2, 2>();
  new_T_old.translation() = (change * Eigen::Vector3d(0.0, 0.0, height)).head<2>();
  placement_ = {placement.manipulator_T_view, placement_.centre};
  view_T_manipulator_ = view_T_manipulator;
  if ((new_T_old * placement_.centre - placement_.centre).norm() > kCarried_m) {
    trim_ = RegistrationTrim(options_.trim, placement_.centre);
  } else {
    trim_.rebase(new_T_old);
  }
}

void ServoCycle::startView(const ViewPlacement& placement) noexcept
{
  placement_ = placement;
  view_T_manipulator_ = placement.manipulator_T_view.inverse();
  trim_ = RegistrationTrim(options_.trim, placement.centre);
  forgetRetina();
}

void ServoCycle::rest() noexcept
{
  started_ = false;
  trust_ = HandOver(options_.hand_over);
  aside_.setZero();
  integral_.reset();
  goals_.clear();
  command_ = ServoCommand();
}

void ServoCycle::begin() noexcept
{
  const Eigen::Vector3d deflection = state_->tip - state_->null;
  limiter_.standAt(state_->tip, deflection);
  plant_.standAt(limiter_.withinReach(deflection));
  started_ = true;
}

const ServoCommand& ServoCycle::command(const Eigen::Vector3d& goal_retina, double share) noexcept
{
  return steer(toManipulator(outlook_.retina.toView(goal_retina)), share, outlook_.reason);
}

const ServoCommand& ServoCycle::commandTip(const Eigen::Vector3d& goal, double share) noexcept
{
  const bool has_state = outlook_.reason != Reason::no_state && outlook_.reason != Reason::state_stale;
  return steer(goal, share, has_state ? Reason::none : outlook_.reason);
}

// Somewhat beyond the reach the tip waits at its end; what is farther is no place that anybody meant.
Reason ServoCycle::whyNotThere(const Eigen::Vector3d& wanted) const noexcept
{
  constexpr double kFarthest = 2.0;  // reaches
  if (!wanted.allFinite()) return Reason::goal_not_finite;
  const double farthest = kFarthest * options_.limits.reach_mm * kMilli;
  return (wanted - outlook_.hand).norm() > farthest ? Reason::out_of_reach : Reason::none;
}

const ServoCommand& ServoCycle::steer(const Eigen::Vector3d& wanted, double share, Reason why) noexcept
{
  command_.reason = why != Reason::none ? why : whyNotThere(wanted);
  refusals_.count(command_.reason);
  if (command_.reason == Reason::no_state || command_.reason == Reason::state_stale) return command_;
  if (!started_) begin();
  const bool known = command_.reason == Reason::none;
  if (known) aside_ = wanted - outlook_.hand;
  command_.share = std::clamp(std::isfinite(share) ? share : 0.0, 0.0, 1.0) * trust_.update(known, outlook_.step_s);
  const bool whole = known && command_.share == 1.0;
  command_.goal =
      limiter_.goal(whole ? wanted : Eigen::Vector3d(outlook_.hand + command_.share * aside_), outlook_.step_s);
  if (goals_.empty() || outlook_.utime > goals_.utime(0)) goals_.push(outlook_.utime, command_.goal);
  const Eigen::Vector3d deflection = command_.goal + integral_.correction() - nullAt(outlook_.utime);
  command_.deflection = limiter_.deflection(deflection, outlook_.step_s);
  command_.saturated = limiter_.isSaturated();
  // The controller subtracts the null that it measures itself. What it is expected to measure is added, so that only
  // the surprise since this state reaches the tip: fresher than any state that came by message.
  const Eigen::Vector3d asked = limiter_.withinReach(plant_.shape(command_.deflection));
  command_.position = null_at_controller_ ? Eigen::Vector3d(asked + nullAt(now_)) : asked;
  return command_;
}

}  // namespace eyeslam::servo
