// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/servo.h"

#include <algorithm>
#include <utility>

#include "eyeslam/retina/units.h"
#include "eyeslam/servo/loop_time.h"
#include "eyeslam/servo/unknown.h"

namespace eyeslam::servo {

using messaging::GoalReference;
using messaging::LaserAction;
using messaging::MicronMode;
using messaging::MicronState;
using retina::Reason;

namespace {

constexpr std::int64_t kRegistrationPeriod_us = 1'000'000;  // contracts, section 4

double ageOf(const messaging::ChannelReceiver& channel, std::int64_t monotonic)
{
  return channel.accepted() == 0 ? kUnknown : seconds(channel.silence(monotonic));
}

}  // namespace

Servo::Servo(const ServoOptions& options, messaging::Link& link)
    : options_(options),
      ears_(link),
      motions_(link),
      lasers_(link),
      statuses_(link),
      registrations_(link),
      operator_(ears_, microseconds(options.health.operator_silence_ms * kMilli)),
      monitor_(options.health, ears_),
      hand_over_(options.cycle.hand_over),
      cycle_(options.cycle, {}),
      senses_(options_, ears_, cycle_),
      guidance_(options.guidance),
      calibration_(options.sweep),
      burning_(options.burning),
      report_(microseconds(1.0 / options.status_hz))
{}

std::shared_ptr<const Preparation> Servo::adopt(std::shared_ptr<const Preparation> preparation) noexcept
{
  std::swap(preparation_, preparation);
  guidance_.adopt(preparation_.get());
  return preparation;
}

void Servo::adopt(const CalibrationResult& calibration, std::int64_t utime) noexcept
{
  senses_.desk().adopt(calibration, utime);
}

const CalibrationSamples* Servo::samples() const noexcept
{
  return calibration_.hasSamples() ? &senses_.desk().samples() : nullptr;
}

void Servo::cycle(const messaging::ReceiveTime& now, const CycleTiming& timing) noexcept
{
  now_ = now;
  commanded_ = motion_.has_value();
  motion_.reset();
  try {
    run(timing);
  } catch (...) {
    fail();
  }
}

// What must not happen has happened: nothing is commanded any more, and every command in force lapses.
void Servo::fail() noexcept
{
  trouble_ = Reason::internal_error;
  motion_.reset();
  cycle_.rest();
  health_.cycle = trouble_;
  supervisor_.update(wish_, health_);
  report_.setState(static_cast<messaging::ServoState>(supervisor_.state()), supervisor_.reason());
}

void Servo::run(const CycleTiming& timing)
{
  wish_ = operator_.update(now_.monotonic);
  if (closes_) wish_.mode = Mode::standby;
  if (wish_.rearmed) rearm();
  const Outlook& outlook = cycle_.observe(senses_.take(now_.monotonic, preparation_ ? preparation_->um_per_px : 0.0));
  supervise(outlook);
  burn(outlook);
  move(outlook);
  publishLaser();
  publishRegistration();
  publishStatus(timing);
}

void Servo::rearm() noexcept
{
  ears_.acceptNewSessions();
  monitor_.forget();
}

bool Servo::hasState(const Outlook& outlook) const noexcept
{
  return outlook.reason != Reason::no_state && outlook.reason != Reason::state_stale;
}

bool Servo::wantsCalibration() const noexcept
{
  const messaging::OperatorWish* said = ears_.operators.latest();
  return said && said->fixture.kind == messaging::FixtureKind::calibration;
}

// A controller that is commanded all the time and yet finds every command too old, or hears none: they are held up on
// their way. Counted in cycles, for the servo's own pauses are none of that.
Reason Servo::whyNotObeyed() noexcept
{
  const MicronState* state = ears_.states.latest();
  const Reason why = state ? state->reason : Reason::none;
  const bool refused = why == Reason::expired || why == Reason::no_command || why == Reason::clock_stepped;
  unobeyed_ = refused && commanded_ ? unobeyed_ + 1 : 0;
  return unobeyed_ > options_.command_expiry_ms ? why : Reason::none;
}

LoopSigns Servo::signs(const Outlook& outlook) noexcept
{
  LoopSigns signs;
  signs.cycle = std::exchange(trouble_, Reason::none);
  signs.state = hasState(outlook) ? Reason::none : outlook.reason;
  signs.fixture = fixture_reason_;
  signs.plan = burning_.planReason();
  signs.commands = whyNotObeyed();
  // What guides without the camera asks for none.
  const bool blind = wish_.mode == Mode::assist && !guidance_.needsRetina();
  if (blind) return signs;
  signs.registration = senses_.desk().reason();
  signs.retina = senses_.retina();
  return signs;
}

void Servo::supervise(const Outlook& outlook)
{
  static const messaging::OperatorWish kNothing;
  const messaging::OperatorWish* said = ears_.operators.latest();
  fixture_reason_ = guidance_.serve(said ? *said : kNothing, senses_.frame());
  health_ = monitor_.judge(signs(outlook), now_.monotonic);
  supervisor_.update(wish_, health_);
  report_.setState(static_cast<messaging::ServoState>(supervisor_.state()), supervisor_.reason());
  if (supervisor_.moves()) last_moving_ = now_.monotonic;
  calibration_.update(supervisor_.state() == State::assist && wantsCalibration(), now_.monotonic, senses_.shaft(),
                      senses_.desk());
}

// In every state, so that the fate of a pulse is always learnt.
void Servo::burn(const Outlook& outlook) noexcept
{
  BurnInput input;
  input.now = now_.monotonic;
  input.step_s = outlook.step_s;
  input.laser_state = supervisor_.state() == State::laser;
  input.wish = ears_.operators.latest();
  input.operator_age = ageOf(ears_.operators, now_.monotonic);
  input.laser = ears_.lasers.latest();
  input.laser_age = ageOf(ears_.lasers, now_.monotonic);
  input.preparation = preparation_.get();
  senses_.describe(outlook, input);
  burn_ = burning_.step(input);
}

bool Servo::isGuided() const noexcept
{
  if (supervisor_.state() == State::laser) return burn_.goal.has_value();
  return supervisor_.state() == State::assist && !burn_goal_ && guidance_.guides();
}

// A target that is given up is left by the ramp alone: another goal in its place would be a step.
Eigen::Vector3d Servo::goalOf(const Outlook& outlook, double share) noexcept
{
  const Eigen::Vector3d fixture_goal = guidance_.goal(outlook);
  if (burn_.goal) burn_goal_ = burn_.goal;
  if (share <= 0.0) burn_goal_.reset();
  return burn_goal_.value_or(fixture_goal);
}

const ServoCommand& Servo::guide(const Outlook& outlook) noexcept
{
  const double share = hand_over_.update(isGuided(), outlook.step_s);
  const bool engaged = supervisor_.state() == State::assist || share > 0.0;
  guidance_.engage(engaged ? Guidance::Engaged::yes : Guidance::Engaged::no);
  const Eigen::Vector3d goal = goalOf(outlook, share);
  if (wantsCalibration() && supervisor_.state() != State::laser && !burn_goal_)
    return cycle_.commandTip(outlook.hand + calibration_.deflection(now_.monotonic, senses_.shaft()), share);
  return cycle_.command(goal, share);
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
  const Eigen::Vector3d goal = guide(outlook).position;
  const std::optional<MicronMode> mode = modeOf(outlook);
  if (mode != MicronMode::follow) cycle_.rest();
  if (mode) publishMotion(*mode, goal);
}

void Servo::publishMotion(MicronMode mode, const Eigen::Vector3d& goal)
{
  messaging::MicronCommand motion;
  motion.utime_image = senses_.utimeImage();
  motion.mode = mode;
  motion.reference = options_.cycle.null_at == "controller" ? GoalReference::tip : GoalReference::deflection;
  if (mode == MicronMode::follow) motion.goal = goal;
  const std::optional<Eigen::Vector3d> pivot = senses_.pivot();
  motion.keep_pivot = pivot.has_value();
  motion.pivot = pivot.value_or(Eigen::Vector3d::Zero());
  const MicronState* state = ears_.states.latest();
  const double bound = options_.speed_bound_mm_s * kMilli;
  motion.speed_bound = state ? std::min(bound, state->abilities.speed_limit) : bound;
  motion.expiry = options_.command_expiry_ms * kMilli;
  if (!motions_.publish(motion, state ? ears_.states.header().utime : now_.utime, now_.utime)) {
    trouble_ = Reason::internal_error;
    return;
  }
  motion_ = motion;
  if (senses_.poseCame()) report_.setFrameToCommand(seconds(now_.monotonic - cycle_.retina().utime()));
}

// While it is meant, and once it is not, for a while: what is off is said, though every command lapses by itself.
void Servo::publishLaser()
{
  messaging::LaserCommand command = burn_.command;
  // The surface is found by the aiming beam.
  if (calibration_.phase() == CalibrationRun::Phase::sweeps) command.action = LaserAction::aim;
  if (command.action != LaserAction::off) last_lit_ = now_.monotonic;
  const double passed = seconds(now_.monotonic - last_lit_);
  if (last_lit_ == 0 || passed > options_.cycle.hand_over.ramp_ms * kMilli) return;
  command.utime_image = senses_.utimeImage();
  const std::int64_t utime = ears_.states.latest() ? ears_.states.header().utime : now_.utime;
  if (!lasers_.publish(command, utime, now_.utime)) trouble_ = Reason::internal_error;
}

void Servo::publishRegistration()
{
  const RegistrationDesk& desk = senses_.desk();
  const bool changed = desk.adoptions() != adoptions_ || desk.reason() != registration_reason_;
  if (!changed && now_.monotonic - registered_at_ < kRegistrationPeriod_us) return;
  adoptions_ = desk.adoptions();
  registration_reason_ = desk.reason();
  registered_at_ = now_.monotonic;
  registrations_.publish(desk.published(), now_.utime, now_.utime);
}

void Servo::publishStatus(const CycleTiming& timing)
{
  report_.gather(ears_, timing, now_.monotonic);
  const RetinaPredictor& retina = cycle_.retina();
  const bool seen = retina.isReady();
  report_.setPose(seen ? senses_.frame().map_id : 0, seen ? seconds(now_.monotonic - retina.utime()) : -1.0);
  if (report_.isDue(now_.monotonic)) statuses_.publish(report_.status(), now_.utime, now_.utime);
}

}  // namespace eyeslam::servo
