// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/servo_senses.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"
#include "eyeslam/servo/loop_time.h"
#include "eyeslam/servo/unknown.h"

namespace eyeslam::servo {

using messaging::MicronState;
using retina::Reason;

namespace {

constexpr double kWithin95 = 2.4477;        // sigmas: 95 % of a circular normal distribution
constexpr std::int64_t kGlance_us = 1'000;  // over which the retina's speed is taken

double largestSigma(double a, double b) { return std::sqrt(std::max({0.0, a, b})); }

}  // namespace

ServoSenses::ServoSenses(const ServoOptions& options, const ServoEars& ears, ServoCycle& cycle)
    : options_(options), ears_(ears), cycle_(cycle), desk_(options.registration), pivot_(options.pivot)
{
  scale_.centre_px = 0.5 * Eigen::Vector2d(options.image_width_px - 1.0, options.image_height_px - 1.0);
}

const CycleInput& ServoSenses::take(std::int64_t now, double prepared_um_per_px) noexcept
{
  input_ = CycleInput();
  input_.now = now;
  pose_jumped_ = pose_came_ = false;
  placeView(prepared_um_per_px);
  takeState();
  takePose();
  takeTip();
  return input_;
}

// Everything in metres of the view uses one nominal scale; what that lacks is in the placement.
void ServoSenses::placeView(double prepared_um_per_px) noexcept
{
  const bool unchanged = adoptions_ == desk_.adoptions() && refined_ == desk_.utime() &&
                         (!(prepared_um_per_px > 0.0) || prepared_um_per_px == scale_.um_per_px);
  if (unchanged || !desk_.good()) return;
  ViewScale scale = scale_;
  if (prepared_um_per_px > 0.0) scale.um_per_px = prepared_um_per_px;
  if (!(scale.um_per_px > 0.0)) scale.um_per_px = desk_.umPerPx();
  const std::optional<ViewPlacement> placement = desk_.placement(scale);
  if (!placement) return;
  if (scale.um_per_px == scale_.um_per_px && adoptions_ == desk_.adoptions()) {
    cycle_.setPlacement(*placement);
  } else {
    cycle_.startView(*placement);
    ++views_;
  }
  scale_ = scale;
  adoptions_ = desk_.adoptions();
  refined_ = desk_.utime();
}

std::optional<Eigen::Vector3d> ServoSenses::pivot() const noexcept
{
  return options_.keeps_pivot ? pivot_.pivot() : std::nullopt;
}

void ServoSenses::takeState() noexcept
{
  if (ears_.states.accepted() == states_) return;
  states_ = ears_.states.accepted();
  const MicronState& state = *ears_.states.latest();
  if (!state.pose_measured) return;
  const std::int64_t utime = ears_.states.toReceiver(ears_.states.header().utime);
  input_.state = ManipulatorState{utime, state.null.position, state.tip.position, std::nullopt};
  if (state.port_measured) input_.state->port = state.port_displacement.head<2>();
  shaft_ = state.tip.orientation * Eigen::Vector3d::UnitZ();
  cycle_.setLead(state.abilities.lead);
  desk_.observe(utime, state.tip.position, shaft_);
  pivot_.observe(state.null, state.port_displacement);
}

void ServoSenses::takePose() noexcept
{
  if (ears_.poses.accepted() == poses_) return;
  poses_ = ears_.poses.accepted();
  const messaging::RetinaPose& pose = *ears_.poses.latest();
  if (!pose.motion.tracked) return;
  if (!(scale_.um_per_px > 0.0)) {  // of use only once the view is placed, but it is there
    pose_.utime = ears_.poses.toReceiver(pose.frame.utime);
    return;
  }
  if (pose.map.id != map_id_) cycle_.forgetRetina();
  map_id_ = pose.map.id;
  const Eigen::Matrix3d& covariance = pose.motion.covariance;
  const SeenPose seen{ears_.poses.toReceiver(pose.frame.utime), viewTRetina(pose.motion.map_T_frame, metresPerPx()),
                      metresPerPx() * largestSigma(covariance(0, 0), covariance(1, 1)),
                      largestSigma(covariance(2, 2), 0.0)};
  pose_jumped_ = jumpedTooFar(seen);
  if (pose_jumped_) return;
  input_.pose = pose_ = seen;
  utime_image_ = pose.frame.utime;
  pose_came_ = true;
  pose_came_at_ = input_.now;
}

// Of the image's centre and of the tip's place, as far as there is a pose to be expected from. After a longer loss
// there is none.
bool ServoSenses::jumpedTooFar(const SeenPose& pose) const noexcept
{
  if (retina() != Reason::none || !cycle_.retina().isReady()) return false;
  const retina::Pose2 expected = cycle_.retina().at(pose.utime).view_T_retina;
  const Eigen::Vector2d tip = cycle_.tipInView() - metresPerPx() * scale_.centre_px;
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(0.0, 0.0), tip}) {
    const Eigen::Vector2d there = pose.view_T_retina * (expected.inverse() * place);
    if (!((there - place).norm() <= kMicro * options_.largest_jump_um)) return true;
  }
  return false;
}

void ServoSenses::takeTip() noexcept
{
  if (ears_.tips.accepted() == tips_) return;
  tips_ = ears_.tips.accepted();
  messaging::InstrumentSight sight = *ears_.tips.latest();
  sight.frame.utime = ears_.tips.toReceiver(sight.frame.utime);
  desk_.see(sight);
  if (!sight.tip.present || !(scale_.um_per_px > 0.0)) return;
  const Eigen::Matrix2d& covariance = sight.tip.covariance;
  input_.tip = SeenTip{sight.frame.utime, sight.frame.exposure, metresPerPx() * sight.tip.position_px,
                       metresPerPx() * largestSigma(covariance(0, 0), covariance(1, 1))};
}

Reason ServoSenses::retina() const noexcept
{
  if (pose_jumped_) return Reason::pose_jumped;
  if (pose_.utime == 0) return Reason::no_pose;
  // A view that has just been placed anew waits for its first pose no longer than for any other.
  const bool old = seconds(input_.now - pose_.utime) > options_.cycle.pose_limit_ms * kMilli;
  return old ? Reason::pose_stale : Reason::none;
}

// @param place  view frame, about the image's centre
double ServoSenses::poseError(const Eigen::Vector2d& place) const noexcept
{
  return kWithin95 * std::hypot(pose_.sigma, pose_.sigma_theta * place.norm());
}

// At the tip, by what is expected of the retina within a moment: the port's part is in it.
double ServoSenses::retinaSpeed(const Outlook& outlook) const noexcept
{
  const Eigen::Vector2d place = outlook.null_retina.head<2>() - outlook.retina.centre;
  const retina::Pose2 later = cycle_.retina().at(outlook.utime + kGlance_us).view_T_retina;
  return (later * place - outlook.retina.view_T_retina * place).norm() / seconds(kGlance_us);
}

void ServoSenses::describe(const Outlook& outlook, BurnInput& input) const noexcept
{
  const RetinaPredictor& retina = cycle_.retina();
  const messaging::RetinaPose* pose = ears_.poses.latest();
  input.map_id = map_id_;
  input.registered = desk_.good();
  input.um_per_px = desk_.umPerPx();
  input.tracked = pose && pose->motion.tracked && retina.isReady() && this->retina() == Reason::none;
  if (!input.tracked) return;
  input.pose_utime = retina.utime();
  input.pose_age = seconds(input_.now - retina.utime());
  input.since_pose = pose_came_at_ == 0 ? kUnknown : seconds(input_.now - pose_came_at_);
  input.innovation = retina.surprise();
  input.since_jump = retina.jumpUtime() == 0 ? kUnknown : seconds(input_.now - retina.jumpUtime());
  input.retina_speed = retinaSpeed(outlook);
  const MicronState* state = ears_.states.latest();
  if (!state) return;
  input.tip_utime = ears_.states.toReceiver(ears_.states.header().utime);
  input.tip = cycle_.onRetina(state->tip.position, input.tip_utime);
  input.shaft = cycle_.directionOnRetina(shaft_, input.tip_utime);
  input.null = outlook.null_retina;
  input.view = {metresPerPx() * scale_.centre_px, outlook.retina.view_T_retina};
  input.view_size = 2.0 * input.view.centre;
  input.reach = std::min(state->abilities.reach_lateral, kMilli * options_.cycle.limits.reach_mm);
  input.reach_left = input.reach - (state->tip.position - state->null.position).norm();
  input.pose_error = poseError(cycle_.tipInView() - metresPerPx() * scale_.centre_px);
  const messaging::InstrumentSight* sight = ears_.tips.latest();
  if (!sight || !(scale_.um_per_px > 0.0)) return;
  input.sight_utime = ears_.tips.toReceiver(sight->frame.utime);
  if (!sight->spot.present) return;
  const ViewPose then{metresPerPx() * scale_.centre_px, retina.at(input.sight_utime).view_T_retina};
  const Eigen::Vector2d spot = metresPerPx() * sight->spot.position_px;
  input.spot = then.toRetina(Eigen::Vector3d(spot.x(), spot.y(), 0.0)).head<2>();
}

}  // namespace eyeslam::servo
