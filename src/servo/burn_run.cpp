// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/burn_run.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/fixtures/keep_out.h"

namespace eyeslam::servo {

using retina::Reason;

namespace {

constexpr std::size_t kScannedPerCycle = 8;  // targets looked at in one cycle: what was burnt is a long list
constexpr double kArrived = 20e-6;           // m, of the travelling goal: the dwell begins
constexpr std::size_t kMean = 5;             // states of the tip

MotionLimiterOptions travelOptions(const BurnRunOptions& options)
{
  MotionLimiterOptions travel;
  travel.speed_mm_s = options.travel_mm_s;
  travel.acceleration_m_s2 = options.travel_m_s2;
  travel.braking_m_s2 = 0.5 * options.travel_m_s2;
  return travel;
}

double metresPerPx(const Preparation& preparation) { return 1e-6 * preparation.um_per_px; }

const fixtures::BurnTarget& targetOf(const Preparation& preparation, std::size_t index)
{
  return preparation.proposed.plan->targets[index];
}

Eigen::Vector2d placeOf(std::size_t index, const Preparation& preparation)
{
  return metresPerPx(preparation) * targetOf(preparation, index).position_px;
}

// Metres of the retina frame; what is no number lies on everything.
double distanceTo(const messaging::Zone& zone, const Eigen::Vector2d& place, double m_per_px)
{
  fixtures::KeepOutZone shape;
  shape.count = static_cast<std::size_t>(std::clamp(zone.corners, 0, messaging::Zone::kMostCorners));
  for (std::size_t i = 0; i < shape.count; ++i) {
    shape.corners[i] = m_per_px * zone.corner_px.col(static_cast<Eigen::Index>(i)).cast<double>();
  }
  Eigen::Vector2d outward;
  return fixtures::zoneDistance(shape, place, outward);
}

}  // namespace

BurnRun::BurnRun(const BurnRunOptions& options)
    : options_(options), interlocks_(options.interlocks), aim_(options.aim), travel_(travelOptions(options))
{}

const BurnOutput& BurnRun::step(const BurnInput& input) noexcept
{
  output_ = {};
  output_.command.utime_image = input.pose_utime;
  takePlan(input);
  observe(input);
  judge(input);
  followPulse(input);
  if (!input.laser_state) {
    rest();
    output_.reason = Reason::not_in_laser;
    return output_;
  }
  output_.command.action = messaging::LaserAction::aim;
  if (plan_reason_ != Reason::none) {
    rest();
    output_.reason = plan_reason_;
    return output_;
  }
  if (isAimed(input)) {
    if (pulse_.isIdle()) choose(input);
    approach(input);
    judge(input);
  }
  fire(input);
  return output_;
}

Reason BurnRun::whyNotInForce(const BurnInput& input) const noexcept
{
  if (input.preparation == nullptr || !input.preparation->proposed.plan) return Reason::plan_not_in_force;
  const Preparation& preparation = *input.preparation;
  if (input.wish == nullptr || !input.wish->plan_approved || input.wish->plan_hash != preparation.proposed.hash)
    return Reason::plan_not_in_force;
  if (preparation.plan_reason != Reason::none) return preparation.plan_reason;
  if (preparation.map_id != input.map_id) return Reason::map_changed;
  const double scale = preparation.proposed.plan->um_per_px / input.um_per_px;
  if (!(std::abs(scale - 1.0) <= options_.scale_tolerance)) return Reason::plan_scale;
  return Reason::none;
}

// A plan is opened only where no pulse of another is under way, so that its fate is not written into the wrong one.
void BurnRun::takePlan(const BurnInput& input) noexcept
{
  plan_reason_ = whyNotInForce(input);
  if (plan_reason_ != Reason::none || ledger_.isOf(input.preparation->proposed.hash)) return;
  if (!pulse_.isIdle()) {
    plan_reason_ = Reason::pulse_unconfirmed;
    return;
  }
  ledger_.open(input.preparation->proposed);
  rest();
}

void BurnRun::rest() noexcept
{
  target_.reset();
  scan_ = 0;
  passed_over_ = Reason::plan_done;
  last_scan_ = Reason::approaching;
  travelling_ = false;
  dwelt_s_ = settled_s_ = waited_s_ = 0.0;
}

void BurnRun::observe(const BurnInput& input) noexcept
{
  if (input.map_id != map_id_) aim_.reset();
  map_id_ = input.map_id;
  const bool newer = tips_.empty() || input.tip_utime > tips_.utime(0);
  if (newer && input.tip.allFinite()) tips_.push(input.tip_utime, input.tip);
  aim_.observe(input.tip_utime, input.tip, input.shaft);
  if (input.spot && input.tracked) aim_.correct(input.sight_utime, *input.spot);
  seeSpot(input);
}

bool BurnRun::isAimed(const BurnInput& input) const noexcept
{
  return aim_.isReady() && aim_.utime() == input.tip_utime && !tips_.empty() && tips_.utime(0) == input.tip_utime;
}

void BurnRun::followPulse(const BurnInput& input) noexcept
{
  const Reason why = plan_reason_ != Reason::none ? plan_reason_ : interlocks_.whyNotGoOn(conditions_);
  const std::optional<PulseFate> fate = pulse_.follow({input.laser, input.laser_age}, why, input.now);
  if (!fate) return;
  const bool whole = fate->emitted_s >= options_.whole_share * fate->asked_s;
  const bool again = !fate->begun && ledger_.at(fate->index).attempts < options_.attempts;
  if (whole) {
    ledger_.record(fate->index, Fate::done, Reason::none, fate->emitted_s);
    ledger_.remember(pulse_map_id_, pulse_place_px_);
  } else if (!again) {
    ledger_.record(fate->index, Fate::missed, fate->reason, fate->emitted_s);
  }
  rest();
}

Reason BurnRun::whyNotTarget(std::size_t index, const BurnInput& input) const noexcept
{
  const Preparation& preparation = *input.preparation;
  if (index >= preparation.verdicts.size() || index >= ledger_.size()) return Reason::target_invalid;
  const TargetRecord& record = ledger_.at(index);
  if (record.fate == Fate::done) return Reason::target_burnt;
  if (record.fate != Fate::pending) return record.reason != Reason::none ? record.reason : Reason::target_invalid;
  const TargetVerdict& verdict = preparation.verdicts[index];
  if (verdict.reason != Reason::none) return verdict.reason;
  if (!(verdict.clearance >= 1e-6 * options_.interlocks.clearance_um)) return Reason::near_vessel;
  return whyZoned(index, input);
}

Reason BurnRun::whyZoned(std::size_t index, const BurnInput& input) const noexcept
{
  if (input.wish->zones == 0) return Reason::none;
  if (input.wish->map_id != input.map_id)
    return Reason::map_changed;  // zones of another map say nothing about this one
  const Preparation& preparation = *input.preparation;
  const fixtures::BurnSafetyOptions& safety = preparation.proposed.plan->prescription.safety;
  const double reach = 1e-6 * (0.5 * targetOf(preparation, index).burn_um + safety.margin_um + safety.localization_um);
  for (int i = 0; i < std::min(input.wish->zones, messaging::OperatorWish::kMostZones); ++i) {
    const messaging::Zone& zone = input.wish->zone[static_cast<std::size_t>(i)];
    const double distance = distanceTo(zone, placeOf(index, preparation), metresPerPx(preparation));
    if (!(distance > reach)) return Reason::in_keep_out;
  }
  return Reason::none;
}

// Burns of this run lie under the target by half of its size: another plan has it again.
bool BurnRun::isBurntAlready(std::size_t index, const Preparation& preparation) const noexcept
{
  const fixtures::BurnTarget& target = targetOf(preparation, index);
  return ledger_.isBurnt(preparation.map_id, target.position_px, 0.5 * target.burn_um / preparation.um_per_px);
}

// The hand and the retina move: what is no target now may be one in a moment. No tip goes where nobody sees it.
Reason BurnRun::whyNotNow(std::size_t index, const BurnInput& input) const noexcept
{
  const Eigen::Vector2d target = placeOf(index, *input.preparation);
  const Eigen::Vector3d tip = aim_.tipFor(target, 1e-6 * options_.standoff_um);
  if (!((tip - input.null).norm() <= input.reach - 1e-6 * options_.interlocks.reach_left_um)) return Reason::reach_ends;
  const bool seen = isInView(tip, input) && isInView({target.x(), target.y(), 0.0}, input);
  return seen ? Reason::none : Reason::out_of_view;
}

bool BurnRun::isInView(const Eigen::Vector3d& place, const BurnInput& input) const noexcept
{
  const Eigen::Vector2d view = input.view.toView(place).head<2>();
  return view.cwiseMin(input.view_size - view).minCoeff() >= 1e-6 * options_.view_margin_um;
}

void BurnRun::choose(const BurnInput& input) noexcept
{
  if (target_) {
    const bool now = whyNotNow(*target_, input) == Reason::none;
    waited_s_ = now ? 0.0 : waited_s_ + std::max(0.0, input.step_s);
    const bool patient = waited_s_ <= 1e-3 * options_.patience_ms;
    if (patient && whyNotTarget(*target_, input) == Reason::none) return;
    rest();
  }
  for (std::size_t looked = 0; looked < kScannedPerCycle && !target_; ++looked) lookAt(input);
}

void BurnRun::lookAt(const BurnInput& input) noexcept
{
  if (scan_ >= ledger_.size()) {
    last_scan_ = passed_over_;
    scan_ = 0;
    passed_over_ = Reason::plan_done;
    return;
  }
  const std::size_t index = scan_++;
  if (whyNotTarget(index, input) != Reason::none) return;
  if (isBurntAlready(index, *input.preparation)) {
    ledger_.record(index, Fate::refused, Reason::target_burnt, 0.0);
  } else if (const Reason why = whyNotNow(index, input); why != Reason::none) {
    passed_over_ = why;
  } else {
    target_ = index;
  }
}

// The tip goes its way at the speed of travel from where it is; at the target the goal follows the shaft and the spot.
void BurnRun::approach(const BurnInput& input) noexcept
{
  if (!target_) return;
  output_.target = targetOf(*input.preparation, *target_).id;
  const Eigen::Vector3d goal = aim_.tipFor(placeOf(*target_, *input.preparation), 1e-6 * options_.standoff_um);
  if (!travelling_) travel_.standAt(input.tip);
  travelling_ = true;
  const Eigen::Vector3d& travelled = travel_.goal(goal, input.step_s);
  output_.goal = travelled;
  const bool arrived = (travelled - goal).norm() <= kArrived;
  dwelt_s_ = arrived ? dwelt_s_ + std::max(0.0, input.step_s) : 0.0;
  const double off = (aim_.spot() - placeOf(*target_, *input.preparation)).norm();
  const bool settled = off <= 1e-6 * options_.interlocks.settled_um;
  settled_s_ = settled ? settled_s_ + std::max(0.0, input.step_s) : 0.0;
}

double BurnRun::speed() const noexcept
{
  if (tips_.size() < 2 * kMean) return kUnknown;
  Eigen::Vector2d newer = Eigen::Vector2d::Zero(), older = Eigen::Vector2d::Zero();
  double passed = 0.0;
  for (std::size_t age = 0; age < kMean; ++age) {
    newer += tips_.value(age).head<2>();
    older += tips_.value(age + kMean).head<2>();
    passed += seconds(tips_.utime(age) - tips_.utime(age + kMean));
  }
  return (newer - older).norm() / passed;
}

// A frame that shows no spot says that it is nowhere near, unless the treatment beam itself may have outshone it.
void BurnRun::seeSpot(const BurnInput& input) noexcept
{
  if (!pulse_.isIdle()) pulse_until_ = input.now;
  if (input.sight_utime <= sight_utime_) return;
  sight_utime_ = input.sight_utime;
  const bool outshone = input.sight_utime >= pulse_from_ && input.sight_utime <= pulse_until_;
  if (input.spot || !outshone) spot_ = input.spot;
}

double BurnRun::spotDistance(const BurnInput& input, const Eigen::Vector2d& place) const noexcept
{
  const LaserInterlocksOptions& limits = options_.interlocks;
  const double oldest = 1e-3 * std::min(limits.oldest_pose_ms, limits.latency_ms + limits.frame_ms);
  const bool fresh = seconds(input.now - sight_utime_) <= oldest;
  return spot_ && fresh ? (*spot_ - place).norm() : kUnknown;
}

void BurnRun::judge(const BurnInput& input) noexcept
{
  PulseConditions& now = conditions_ = {};
  now.laser_state = input.laser_state;
  now.foot_switch = input.laser != nullptr && input.laser->foot_switch;
  now.armed_laser = input.laser != nullptr && input.laser->armed;
  now.interlock_closed = input.laser != nullptr && input.laser->interlock_closed;
  now.armed_by_human = input.wish != nullptr && input.wish->arm && !input.wish->stop;
  now.plan_in_force = plan_reason_ == Reason::none;
  now.registered = input.registered;
  now.tracked = input.tracked;
  now.laser_age = input.laser_age;
  now.operator_age = input.operator_age;
  now.pose_age = input.pose_age;
  now.pose_error = input.pose_error;
  now.innovation = input.innovation;
  now.since_jump = input.since_jump;
  now.reach_left = input.reach_left;
  now.retina_speed = input.retina_speed;
  if (now.plan_in_force && target_) judgeTarget(input);
}

void BurnRun::judgeTarget(const BurnInput& input) noexcept
{
  PulseConditions& now = conditions_;
  now.target_valid = whyNotTarget(*target_, input) == Reason::none;
  now.target_unburnt = *target_ < ledger_.size() && ledger_.at(*target_).fate == Fate::pending;
  if (*target_ >= input.preparation->verdicts.size()) return;
  now.clearance = input.preparation->verdicts[*target_].clearance;
  if (!isAimed(input)) return;
  const Eigen::Vector2d place = placeOf(*target_, *input.preparation);
  now.goal_distance = (aim_.spot() - place).norm();
  now.settled_for = settled_s_;
  now.spot_distance = spotDistance(input, place);
  now.speed = speed();
  now.standoff_error = std::abs(-input.tip.z() - 1e-6 * options_.standoff_um);
}

Reason BurnRun::whyNotFire(const BurnInput& input) const noexcept
{
  if (!pulse_.isIdle()) return Reason::pulse_unconfirmed;
  if (!isAimed(input)) return Reason::beam_misses;
  if (!target_) return last_scan_;
  if (const Reason open = interlocks_.whyNotBegin(conditions_); open != Reason::none) return open;
  if (ledger_.isFull()) return Reason::burns_full;
  const double pulse_s = 1e-3 * targetOf(*input.preparation, *target_).duration_ms;
  if (!(dwelt_s_ >= 1e-3 * options_.dwell_ms - pulse_s)) return Reason::approaching;
  const bool right_after_pose = options_.start_within_ms == 0.0 || input.since_pose <= 1e-3 * options_.start_within_ms;
  return right_after_pose ? Reason::none : Reason::pose_not_new;
}

void BurnRun::fire(const BurnInput& input) noexcept
{
  if (!pulse_.isFiring()) {
    output_.reason = whyNotFire(input);
    if (output_.reason != Reason::none) return;
    const fixtures::BurnTarget& target = targetOf(*input.preparation, *target_);
    messaging::LaserCommand pulse;
    pulse.target = target.id;
    pulse.duration = 1e-3 * target.duration_ms;
    pulse.power = 1e-3 * target.power_mw;
    pulse_.begin(*target_, pulse, {input.laser, input.laser_age}, input.now);
    ledger_.countAttempt(*target_);
    pulse_from_ = pulse_until_ = input.now;
    pulse_map_id_ = input.map_id;
    pulse_place_px_ = target.position_px;
  }
  output_.command = pulse_.command();
  output_.command.utime_image = input.pose_utime;
}

}  // namespace eyeslam::servo
