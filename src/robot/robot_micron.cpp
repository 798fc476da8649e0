// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/robot/robot_micron.h"

#include <visp3/robot/vpRobotException.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "eyeslam/retina/units.h"
#include "eyeslam/robot/tool_jacobian.h"
#include "eyeslam/robot/visp_conversion.h"

namespace eyeslam::robot {

using messaging::GoalReference;
using messaging::MicronCommand;
using messaging::MicronMode;
using messaging::MicronState;
using messaging::ReceiveTime;
using retina::Reason;

namespace {

constexpr double kSlowest = 1e-3;         // m/s, a bound below would not let the tip reach its goal
constexpr double kSpare = 1.25;           // of the speed, so that the tip keeps up with its goal
constexpr double kLongestStep_s = 50e-3;  // a pause counts as no more

Eigen::Vector3d shaftOf(const messaging::ToolPose& pose) { return pose.orientation * Eigen::Vector3d::UnitZ(); }

[[noreturn]] void refuse(int code, const std::string& message) { throw vpRobotException(code, message); }

[[noreturn]] void refuseFrame(const char* what, const char* frames)
{
  refuse(vpRobotException::notImplementedError,
         std::string("RobotMicron has no ") + what + " in this frame: use " + frames);
}

// The first three of 3 or 6 numbers. @param turn  what may stand in the others
enum class Turn { none, ignored };

Eigen::Vector3d translationOf(const vpColVector& numbers, Turn turn, const char* what)
{
  if (numbers.size() != 3 && numbers.size() != 6) {
    refuse(vpException::dimensionError, std::string("RobotMicron: a ") + what + " has 3 numbers, or 6 with a rotation");
  }
  const Eigen::VectorXd all = toEigen(numbers);
  if (!all.allFinite())
    refuse(vpException::badValue, std::string("RobotMicron: a ") + what + " with a number that is none");
  if (turn == Turn::none && all.size() == 6 && !all.tail<3>().isZero(0.0)) {
    refuse(vpException::badValue, "RobotMicron cannot be turned: its orientation follows the hand and the pivot");
  }
  return all.head<3>();
}

Eigen::Vector3d shortened(const Eigen::Vector3d& velocity, double fastest)
{
  const double speed = velocity.norm();
  return speed > fastest ? Eigen::Vector3d(velocity * (fastest / speed)) : velocity;
}

}  // namespace

RobotMicron::RobotMicron(messaging::Link& link, Clock clock, const RobotMicronOptions& options)
    : link_(link),
      clock_(std::move(clock)),
      options_(options),
      pivot_(options.pivot),
      states_(link, [this](const MicronState& state,
                           const messaging::MessageHeader&) { pivot_.observe(state.null, state.port_displacement); }),
      commands_(link)
{
  nDof = 3;
  maxTranslationVelocity = options.speed_mm_s * kMilli;
}

void RobotMicron::init()
{
  for (int waited_ms = 0; waited_ms < options_.wait_ms && getState() == nullptr; ++waited_ms) {
    link_.wait(1);
    keepAlive();
  }
  hear();
}

Reason RobotMicron::whyNot(const ReceiveTime& now) const
{
  const MicronState* state = getState();
  if (state == nullptr) return Reason::no_state;
  if (states_.fault() != Reason::none) return states_.fault();
  if (kMilli * static_cast<double>(states_.silence(now.monotonic)) > options_.state_limit_ms)
    return Reason::state_stale;
  if (!state->powered) return Reason::unpowered;
  if (!state->pose_measured) return Reason::no_state;
  return Reason::none;
}

void RobotMicron::keepAlive()
{
  const ReceiveTime now = clock_();
  link_.drain(now);
  reason_ = whyNot(now);
  command(now);
  last_step_ = now.monotonic;
}

// Hears the controller; from here on there is a state.
const MicronState& RobotMicron::hear()
{
  keepAlive();
  if (reason_ == Reason::none) return *getState();
  const bool silent = reason_ == Reason::no_state || reason_ == Reason::state_stale;
  refuse(silent ? vpRobotException::communicationError : vpRobotException::lowLevelError,
         "Micron cannot be moved: " + std::string(retina::word(reason_)) +
             (silent ? "; does its controller publish MICRON_STATE on " + link_.url() + ", and is the pose measured?"
                     : ""));
}

Workspace RobotMicron::workspace(const MicronState& state) const
{
  return {std::min(options_.reach_lateral_mm * kMilli, state.abilities.reach_lateral),
          std::min(options_.reach_axial_mm * kMilli, state.abilities.reach_axial)};
}

// 0 where the program has set a limit that is none.
double RobotMicron::speedBound(const MicronState& state) const
{
  const double own = std::isfinite(maxTranslationVelocity) ? std::max(0.0, maxTranslationVelocity) : 0.0;
  return std::min({own, options_.speed_mm_s * kMilli, state.abilities.speed_limit});
}

void RobotMicron::command(const ReceiveTime& now)
{
  const bool stopped = getRobotState() == vpRobot::STATE_STOP;
  if (reason_ != Reason::none || stopped || speedBound(*getState()) <= 0.0) {
    started_ = false;
    return;
  }
  const MicronState& state = *getState();
  // The last command has lapsed, and the controller has long taken the tip elsewhere.
  if (kMilli * static_cast<double>(now.monotonic - last_step_) > options_.expiry_ms) started_ = false;
  if (!started_) motion_.startAt(state.tip.position);
  const double step_s = started_ ? 1e-6 * static_cast<double>(now.monotonic - last_step_) : 0.0;
  started_ = true;
  const double age_ms = kMilli * static_cast<double>(now.monotonic - velocity_set_);
  if (motion_.kind() == TipMotion::Kind::velocity && age_ms > options_.velocity_limit_ms) motion_.rest();
  motion_.step(std::clamp(step_s, 0.0, kLongestStep_s), state.null.position, shaftOf(state.null), workspace(state));
  publish(following(state), now);
}

MicronCommand RobotMicron::following(const MicronState& state) const
{
  MicronCommand command;
  command.mode = MicronMode::follow;
  const bool with_hand = motion_.kind() == TipMotion::Kind::deflection;
  command.reference = with_hand ? GoalReference::deflection : GoalReference::tip;
  command.goal = motion_.goal();
  if (with_hand) command.goal -= state.null.position;
  const double fastest = speedBound(state);
  const bool by_velocity = motion_.kind() == TipMotion::Kind::velocity;
  command.speed_bound = by_velocity ? std::min(fastest, std::max(kSlowest, kSpare * motion_.speed())) : fastest;
  return command;
}

void RobotMicron::publish(const MicronCommand& command, const ReceiveTime& now)
{
  MicronCommand whole = command;
  whole.expiry = options_.expiry_ms * kMilli;
  if (const auto pivot = getPivot()) {
    whole.keep_pivot = true;
    whole.pivot = *pivot;
  }
  commands_.publish(whole, states_.header().utime, now.utime);
}

std::optional<Eigen::Vector3d> RobotMicron::getPivot() const
{
  if (!options_.keeps_pivot) return std::nullopt;
  return given_pivot_ ? given_pivot_ : pivot_.pivot();
}

Reason RobotMicron::getReason() const
{
  if (reason_ != Reason::none || getRobotState() == vpRobot::STATE_STOP) return reason_;
  return getState()->reason;
}

vpRobot::vpRobotStateType RobotMicron::setRobotState(vpRobotStateType state)
{
  const bool known = state == STATE_STOP || state == STATE_VELOCITY_CONTROL || state == STATE_POSITION_CONTROL;
  if (!known) {
    refuse(vpRobotException::stateModificationError,
           "RobotMicron has no such control: use STATE_STOP, STATE_VELOCITY_CONTROL or STATE_POSITION_CONTROL");
  }
  if (state == STATE_STOP) {
    keepAlive();
    // At once, where it is heard: else the last command would go on until it lapses.
    if (started_) publish({}, clock_());
    started_ = false;
    return vpRobot::setRobotState(state);
  }
  if (getRobotState() != state && started_) motion_.rest();
  vpRobot::setRobotState(state);
  keepAlive();
  return state;
}

void RobotMicron::requireState(vpRobotStateType state, const char* what)
{
  if (getRobotState() == state) return;
  refuse(vpRobotException::wrongStateError,
         std::string("RobotMicron is not in ") + what + ": call setRobotState first");
}

void RobotMicron::setVelocity(vpControlFrameType frame, const vpColVector& velocity)
{
  requireState(STATE_VELOCITY_CONTROL, "STATE_VELOCITY_CONTROL");
  const MicronState& state = hear();
  // Whatever is refused below: until the program knows what it wants, the tip rests.
  motion_.rest();
  Eigen::Vector3d asked = translationOf(velocity, Turn::none, "velocity");
  switch (frame) {
    case REFERENCE_FRAME:
    case JOINT_STATE:
      break;
    case END_EFFECTOR_FRAME:
      asked = state.tip.orientation * asked;
      break;
    default:
      refuseFrame("velocity", "REFERENCE_FRAME, JOINT_STATE or END_EFFECTOR_FRAME");
  }
  const double fastest = speedBound(state);
  if (fastest <= 0.0)
    refuse(vpException::badValue, "RobotMicron: the largest translation velocity is no positive number");
  motion_.setVelocity(shortened(asked, fastest));
  velocity_set_ = last_step_;
}

void RobotMicron::setPosition(vpControlFrameType frame, const vpColVector& position)
{
  requireState(STATE_POSITION_CONTROL, "STATE_POSITION_CONTROL");
  const MicronState& state = hear();
  motion_.rest();
  if (frame != REFERENCE_FRAME && frame != JOINT_STATE) refuseFrame("position", "REFERENCE_FRAME or JOINT_STATE");
  const bool of_tip = frame == REFERENCE_FRAME;
  const Eigen::Vector3d asked = translationOf(position, of_tip ? Turn::ignored : Turn::none, "position");
  const Eigen::Vector3d way = of_tip ? Eigen::Vector3d(asked - state.null.position) : asked;
  const Workspace reach = workspace(state);
  constexpr double kRounding = 1e-9;
  if ((reach.shortened(way, shaftOf(state.null)) - way).norm() > kRounding) {
    refuse(vpRobotException::positionOutOfRangeError,
           "RobotMicron reaches " + std::to_string(reach.reach_lateral) + " m across the shaft and " +
               std::to_string(reach.reach_axial) + " m along it from the null tip; the position is " +
               std::to_string(way.norm()) + " m away");
  }
  of_tip ? motion_.setPosition(asked) : motion_.setDeflection(asked);
}

void RobotMicron::getPosition(vpControlFrameType frame, vpColVector& position)
{
  if (frame != REFERENCE_FRAME && frame != JOINT_STATE) refuseFrame("position", "REFERENCE_FRAME or JOINT_STATE");
  const MicronState& state = hear();
  position = frame == REFERENCE_FRAME ? poseVector(state.tip.position, state.tip.orientation)
                                      : toVisp(Eigen::VectorXd(state.tip.position - state.null.position));
}

void RobotMicron::getDisplacement(vpControlFrameType frame, vpColVector& displacement)
{
  if (frame != REFERENCE_FRAME && frame != JOINT_STATE && frame != END_EFFECTOR_FRAME) {
    refuseFrame("displacement", "REFERENCE_FRAME, JOINT_STATE or END_EFFECTOR_FRAME");
  }
  const MicronState& now = hear();
  const MicronState before = displaced_from_.value_or(now);
  displaced_from_ = now;
  const Eigen::Vector3d moved = now.tip.position - before.tip.position;
  const Eigen::Quaterniond own_turn = before.tip.orientation.conjugate() * now.tip.orientation;
  switch (frame) {
    case JOINT_STATE:
      displacement = toVisp(Eigen::VectorXd(moved - (now.null.position - before.null.position)));
      return;
    case END_EFFECTOR_FRAME:
      displacement = poseVector(before.tip.orientation.conjugate() * moved, own_turn);
      return;
    default:
      displacement = poseVector(moved, now.tip.orientation * before.tip.orientation.conjugate());
  }
}

void RobotMicron::get_fJe(vpMatrix& jacobian)
{
  const MicronState& state = hear();
  jacobian = toVisp(Eigen::MatrixXd(toolJacobian(state.tip.position, getPivot())));
}

void RobotMicron::get_eJe(vpMatrix& jacobian)
{
  const MicronState& state = hear();
  const ToolJacobian in_manipulator = toolJacobian(state.tip.position, getPivot());
  jacobian = toVisp(Eigen::MatrixXd(inToolAxes(in_manipulator, state.tip.orientation)));
}

vpHomogeneousMatrix RobotMicron::get_fMe()
{
  const MicronState& state = hear();
  return toVisp(state.tip.position, state.tip.orientation);
}

}  // namespace eyeslam::robot
