// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/servo.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "eyeslam/servo/loop_time.h"

namespace eyeslam::servo {

using messaging::GoalReference;
using messaging::MicronMode;
using messaging::MicronState;
using retina::Reason;

namespace {

constexpr double kMicro = 1e-6;
constexpr double kMilli = 1e-3;

double lateralSigma(const Eigen::Matrix3d& covariance)
{
  const double largest = std::max(covariance(0, 0), covariance(1, 1));
  return std::sqrt(std::max(0.0, largest));
}

}  // namespace

Servo::Servo(const ServoOptions& options, messaging::Link& link)
    : options_(options),
      ears_(link),
      motions_(link),
      statuses_(link),
      operator_(ears_, microseconds(options.health.operator_silence_ms * kMilli)),
      monitor_(options.health, ears_),
      hand_over_(options.cycle.hand_over),
      cycle_(options.cycle, {}),
      guidance_(options.guidance),
      pivot_(options.pivot),
      report_(microseconds(1.0 / options.status_hz))
{}

std::shared_ptr<const Preparation> Servo::adopt(std::shared_ptr<const Preparation> preparation) noexcept
{
  std::swap(preparation_, preparation);
  guidance_.adopt(preparation_.get());
  return preparation;
}

void Servo::adopt(const CalibrationResult& calibration, std::int64_t) noexcept
{
  registration_ = calibration.camera.result();
  plane_ = calibration.plane;
  scale_.um_per_px = 0.0;
}

void Servo::cycle(const messaging::ReceiveTime& now, const CycleTiming& timing) noexcept
{
  now_ = now;
  try {
    run(timing);
  } catch (...) {
    fail();
  }
}

// What must not happen has happened: nothing is commanded any more but what ends motion softly.
void Servo::fail() noexcept
{
  trouble_ = Reason::internal_error;
  cycle_.rest();
  health_.cycle = trouble_;
  supervisor_.update(wish_, health_);
  report_.setState(static_cast<messaging::ServoState>(supervisor_.state()), supervisor_.reason());
}

void Servo::run(const CycleTiming& timing)
{
  wish_ = operator_.update(now_.monotonic);
  if (wish_.rearmed) rearm();
  placeView();
  const Outlook& outlook = cycle_.observe(input());
  supervise(outlook);
  move(outlook);
  publishStatus(timing);
}

void Servo::rearm() noexcept
{
  ears_.acceptNewSessions();
  monitor_.forget();
}

// Everything that is in metres of the view uses one nominal scale; what it lacks is in the placement.
void Servo::placeView() noexcept
{
  if (!registration_.good() || !plane_) return;
  const double prepared = preparation_ ? preparation_->um_per_px : 0.0;
  const double um_per_px = prepared > 0.0 ? prepared : registration_.umPerPx(*plane_).value_or(0.0);
  if (um_per_px == scale_.um_per_px) return;
  const ViewScale scale{um_per_px,
                        0.5 * Eigen::Vector2d(options_.image_width_px - 1.0, options_.image_height_px - 1.0)};
  const std::optional<ViewPlacement> placement = servo::placeView(registration_, *plane_, scale);
  if (!placement) return;
  scale_ = scale;
  cycle_.startView(*placement);
}

CycleInput Servo::input() noexcept
{
  CycleInput input;
  input.now = now_.monotonic;
  pose_jumped_ = pose_came_ = false;
  takeState(input);
  takePose(input);
  takeTip(input);
  return input;
}

void Servo::takeState(CycleInput& input) noexcept
{
  if (ears_.states.accepted() == states_taken_) return;
  states_taken_ = ears_.states.accepted();
  const MicronState& state = *ears_.states.latest();
  if (!state.pose_measured) return;
  ManipulatorState measured{ears_.states.toReceiver(ears_.states.header().utime), state.null.position,
                            state.tip.position, std::nullopt};
  if (state.port_measured) measured.port = state.port_displacement.head<2>();
  input.state = measured;
  cycle_.setLead(state.abilities.lead);
  pivot_.observe(state.null, state.port_displacement);
}

void Servo::takePose(CycleInput& input) noexcept
{
  if (ears_.poses.accepted() == poses_taken_ || !(scale_.um_per_px > 0.0)) return;
  poses_taken_ = ears_.poses.accepted();
  const messaging::RetinaPose& pose = *ears_.poses.latest();
  if (!pose.motion.tracked) return;
  if (pose.map.id != map_id_) cycle_.forgetRetina();
  map_id_ = pose.map.id;
  const double m_per_px = kMicro * scale_.um_per_px;
  const SeenPose seen{ears_.poses.toReceiver(pose.frame.utime), viewTRetina(pose.motion.map_T_frame, m_per_px),
                      m_per_px * lateralSigma(pose.motion.covariance),
                      std::sqrt(std::max(0.0, pose.motion.covariance(2, 2)))};
  pose_jumped_ = jumpedTooFar(seen);
  if (pose_jumped_) return;
  input.pose = seen;
  utime_image_ = pose.frame.utime;
  pose_came_ = true;
}

// Of the image's centre and of the tip's place, as far as there is a pose to be expected from. After a longer loss
// there is none.
bool Servo::jumpedTooFar(const SeenPose& pose) const noexcept
{
  const RetinaPredictor& retina = cycle_.retina();
  if (!retina.isReady() || seconds(now_.monotonic - retina.utime()) > options_.cycle.pose_limit_ms * kMilli)
    return false;
  const retina::Pose2 expected = retina.at(pose.utime).view_T_retina;
  const double farthest = kMicro * options_.largest_jump_um;
  const Eigen::Vector2d tip = cycle_.tipInView() - kMicro * scale_.um_per_px * scale_.centre_px;
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(0.0, 0.0), tip}) {
    const Eigen::Vector2d there = pose.view_T_retina * (expected.inverse() * place);
    if (!((there - place).norm() <= farthest)) return true;
  }
  return false;
}

void Servo::takeTip(CycleInput& input) noexcept
{
  if (ears_.tips.accepted() == tips_taken_ || !(scale_.um_per_px > 0.0)) return;
  tips_taken_ = ears_.tips.accepted();
  const messaging::InstrumentSight& sight = *ears_.tips.latest();
  if (!sight.tip.present) return;
  const double m_per_px = kMicro * scale_.um_per_px;
  const double variance = std::max(sight.tip.covariance(0, 0), sight.tip.covariance(1, 1));
  input.tip = SeenTip{ears_.tips.toReceiver(sight.frame.utime), sight.frame.exposure, m_per_px * sight.tip.position_px,
                      m_per_px * std::sqrt(std::max(0.0, variance))};
}

bool Servo::hasState(const Outlook& outlook) const noexcept
{
  return outlook.reason != Reason::no_state && outlook.reason != Reason::state_stale;
}

LoopSigns Servo::signs(const Outlook& outlook) noexcept
{
  LoopSigns signs;
  signs.cycle = std::exchange(trouble_, Reason::none);
  signs.state = hasState(outlook) ? Reason::none : outlook.reason;
  signs.fixture = fixture_reason_;
  signs.plan = Reason::plan_not_in_force;
  // What guides without the camera asks for none.
  const bool blind = wish_.mode == Mode::assist && !guidance_.needsRetina();
  if (blind) return signs;
  signs.registration = !registration_.good() ? registration_.reason : plane_ ? Reason::none : Reason::surface_unknown;
  const RetinaPredictor& retina = cycle_.retina();
  const bool old = seconds(now_.monotonic - retina.utime()) > options_.cycle.pose_limit_ms * kMilli;
  signs.retina = pose_jumped_        ? Reason::pose_jumped
                 : !retina.isReady() ? Reason::no_pose
                 : old               ? Reason::pose_stale
                                     : Reason::none;
  return signs;
}

void Servo::supervise(const Outlook& outlook)
{
  static const messaging::OperatorWish kNothing;
  const messaging::OperatorWish* said = ears_.operators.latest();
  fixture_reason_ = guidance_.serve(said ? *said : kNothing, {map_id_, scale_.um_per_px});
  health_ = monitor_.judge(signs(outlook), now_.monotonic);
  supervisor_.update(wish_, health_);
  report_.setState(static_cast<messaging::ServoState>(supervisor_.state()), supervisor_.reason());
  if (supervisor_.moves()) last_moving_ = now_.monotonic;
  hand_over_.update(supervisor_.guides() && guidance_.guides(), outlook.step_s);
}

const ServoCommand& Servo::guide(const Outlook& outlook) noexcept
{
  const double share = hand_over_.share();
  return cycle_.command(guidance_.goal(outlook), share);
}

std::optional<MicronMode> Servo::modeOf(const Outlook& outlook) const noexcept
{
  if (!supervisor_.moves()) {
    const double passed = seconds(now_.monotonic - last_moving_);
    const bool ends = last_moving_ != 0 && passed <= options_.cycle.hand_over.ramp_ms * kMilli;
    return ends ? std::optional(MicronMode::cancel_tremor) : std::nullopt;
  }
  const bool goes_on = supervisor_.state() != State::hold || hand_over_.share() > 0.0;
  return hasState(outlook) && goes_on ? MicronMode::follow : MicronMode::cancel_tremor;
}

void Servo::move(const Outlook& outlook)
{
  const bool engaged = supervisor_.guides() || hand_over_.share() > 0.0;
  guidance_.engage(engaged ? Guidance::Engaged::yes : Guidance::Engaged::no);
  const ServoCommand& command = guide(outlook);
  const std::optional<MicronMode> mode = modeOf(outlook);
  motion_.reset();
  if (mode != MicronMode::follow) cycle_.rest();
  if (mode) publishMotion(*mode, &command);
}

void Servo::publishMotion(MicronMode mode, const ServoCommand* command)
{
  messaging::MicronCommand motion;
  motion.utime_image = utime_image_;
  motion.mode = mode;
  motion.reference = options_.cycle.null_at == "controller" ? GoalReference::tip : GoalReference::deflection;
  if (mode == MicronMode::follow) motion.goal = command->position;
  const std::optional<Eigen::Vector3d> pivot = options_.keeps_pivot ? pivot_.pivot() : std::nullopt;
  motion.keep_pivot = pivot.has_value();
  motion.pivot = pivot.value_or(Eigen::Vector3d::Zero());
  const MicronState* state = ears_.states.latest();
  const double fastest = state ? state->abilities.speed_limit : options_.speed_bound_mm_s * kMilli;
  motion.speed_bound = std::min(options_.speed_bound_mm_s * kMilli, fastest);
  motion.expiry = options_.command_expiry_ms * kMilli;
  const std::int64_t utime = state ? ears_.states.header().utime : now_.utime;
  if (!motions_.publish(motion, utime, now_.utime)) trouble_ = Reason::internal_error;
  motion_ = motion;
  if (pose_came_) report_.setFrameToCommand(seconds(now_.monotonic - cycle_.retina().utime()));
}

void Servo::publishStatus(const CycleTiming& timing)
{
  report_.gather(ears_, timing, now_.monotonic);
  const RetinaPredictor& retina = cycle_.retina();
  report_.setPose(retina.isReady() ? map_id_ : 0, retina.isReady() ? seconds(now_.monotonic - retina.utime()) : -1.0);
  if (report_.isDue(now_.monotonic)) statuses_.publish(report_.status(), now_.utime, now_.utime);
}

}  // namespace eyeslam::servo
