// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/trial_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/loop_period.h"
#include "eyeslam/trials/lock_step_time.h"
#include "eyeslam/trials/segment.h"
#include "eyeslam/trials/trial_marks.h"

namespace eyeslam::trials {

namespace {

constexpr double kFarOff = 60e-6;              // issue 17: pulses more than 60 um off
constexpr double kMoved = 40e-6;               // the same: explained where the retina moved more
constexpr double kBack = 150e-6;               // back beside the path: as far as a hand leans (loop study, 1)
constexpr std::int64_t kMostMissing = 10'000;  // milliseconds; a longer gap is another clock's

template <class Message, class Use>
bool takeAs(const files::LogEvent& event, const char* channel, Use use)
{
  if (event.channel != channel) return false;
  Message message{};
  if (messaging::decode(event.data, event.size, message)) use(message);
  return true;
}

retina::Pose2 poseOf(double x, double y, double theta, double scale) { return {x, y, theta, scale}; }

std::string wordOf(std::int16_t reason)
{
  return reason == 0 ? "" : std::string(retina::word(static_cast<retina::Reason>(reason)));
}

}  // namespace

void TrialJudge::take(const files::LogEvent& event)
{
  takeAs<truth_t>(event, "TRUTH", [this](const truth_t& truth) { take(truth); }) ||
      takeAs<mark_t>(event, "MARK", [this](const mark_t& mark) { take(mark); }) ||
      takeAs<retina_pose_t>(event, "RETINA_POSE", [&](const retina_pose_t& pose) { take(pose, event.utime); }) ||
      takeAs<servo_status_t>(event, "SERVO_STATUS", [this](const servo_status_t& status) { take(status); }) ||
      takeAs<laser_state_t>(event, "LASER_STATE", [this](const laser_state_t& state) { laser_ = state; }) ||
      takeAs<operator_t>(event, "OPERATOR", [this](const operator_t& wish) { wish_ = wish; }) ||
      takeAs<burn_plan_t>(event, "BURN_PLAN", [this](const burn_plan_t& plan) { take(plan); }) ||
      takeAs<vessel_map_t>(event, "VESSEL_MAP", [this](const vessel_map_t& tile) { take(tile); });
}

void TrialJudge::take(const mark_t& mark)
{
  const std::optional<TrialName> name = mark.kind == mark_t::START ? TrialName::parse(mark.note) : std::nullopt;
  if (name && !setting_) {
    start_ = mark;
    name_ = *name;
    setting_ = settingOf(name->scenario, mark.configuration);
    if (!scene_) scene_ = std::make_shared<TrialScene>(*setting_, name->seed);
    tip_judge_.emplace(-1.0);
  }
  if (mark.kind == mark_t::NOTE && mark.note == kCountsFromHere && counts_from_ == 0) countFrom(mark.utime);
  if (mark.kind != mark_t::STOP || mark.sender != start_.sender) return;
  over_ = true;
  never_began_ = mark.note == kNeverBegan;
}

// What happened before was told from the start.
void TrialJudge::countFrom(std::int64_t utime)
{
  counts_from_ = utime;
  for (TrialEvent& event : events_) event.t_s += time(start_.utime);
}

void TrialJudge::take(const truth_t& truth)
{
  if (!setting_ || over_) return;
  um_per_px_ = truth.um_per_px;
  rememberRetina(
      {{truth.retina_centre[0], truth.retina_centre[1], 0.0}, Eigen::Vector3d(truth.retina_shift), truth.retina_theta},
      truth.utime);
  if (truth.frame >= 0) {
    const retina::Pose2 pose = poseOf(truth.frame_x_px, truth.frame_y_px, truth.frame_theta, 1.0);
    if (frames_.empty() || frames_.rbegin()->first != truth.frame) frames_.insert({truth.frame, {pose, {}}});
  }
  watchSpeed(truth);
  followPulse(truth);
  if (counts()) judgeTip(truth);
}

// In real time some are lost.
void TrialJudge::rememberRetina(const simulation::RetinaPose& retina, std::int64_t utime)
{
  if (retina_.empty()) first_truth_ = utime;
  const std::int64_t step = (utime - first_truth_ + kPeriod_us / 2) / kPeriod_us;
  const auto missing = std::clamp<std::int64_t>(step - static_cast<std::int64_t>(retina_.size()), 0, kMostMissing);
  retina_.insert(retina_.end(), static_cast<std::size_t>(missing), retina);
  retina_.push_back(retina);
}

// In the world, where the manipulator is.
void TrialJudge::watchSpeed(const truth_t& truth)
{
  const Eigen::Vector3d tip = retina_.back().toWorld(Eigen::Vector3d(truth.tip));
  if (last_world_tip_) fastest_tip_ = std::max(fastest_tip_, (tip - *last_world_tip_).norm() / simulation::kPeriod_s);
  last_world_tip_ = tip;
}

// Beside what is to be followed the tip must be on that; beyond its ends, where a hand leans over and nothing is to be
// followed, on any vessel (loop study: tip to the nearest centreline). Over an end it is beyond until it is back: a
// vessel that turns there may pass beside the path again.
TipSample TrialJudge::sampleOf(const Eigen::Vector3d& tip, double t_s)
{
  const std::vector<Eigen::Vector3d>& line = scene_->path();
  TipSample sample{t_s, tip, std::numeric_limits<double>::infinity()};
  if (setting_->scenario.task == "standoff") {
    sample.error = std::abs(tip.z() - line.front().z());
    return sample;
  }
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector3d& next = line[std::min(i + 1, line.size() - 1)];
    sample.error = std::min(sample.error, distanceToSegment(tip.head<2>(), line[i].head<2>(), next.head<2>()));
  }
  if (setting_->scenario.task != "trace") return sample;
  const auto from = [&tip](const Eigen::Vector3d& end) { return (tip - end).head<2>().norm(); };
  const bool over_an_end = sample.error >= std::min(from(line.front()), from(line.back()));
  beyond_path_ = over_an_end || (beyond_path_ && sample.error > kBack);
  sample.on_path = !beyond_path_;
  if (!sample.on_path) sample.error = std::min(sample.error, scene_->centrelineDistance(tip.head<2>()));
  return sample;
}

void TrialJudge::judgeTip(const truth_t& truth)
{
  const Eigen::Vector3d tip(truth.tip);
  const double t_s = time(truth.utime);
  if (last_tip_) travelled_.push_back((tip - *last_tip_).norm());
  last_tip_ = tip;
  const Eigen::Vector3d null(truth.null);
  if (last_null_) hand_travelled_ += (null - *last_null_).norm();
  last_null_ = null;
  hand_off_um_.push_back((tip - null).norm() / kMicro);
  ++truths_;
  saturated_ += truth.saturated;
  worst_pivot_ = std::max(worst_pivot_, truth.pivot_error);
  if (setting_->scenario.isLaser()) return;
  const TipSample sample = sampleOf(tip, t_s);
  tip_judge_->step({t_s, tip, sample.error, truth.jerk != 0, Eigen::Vector2d(truth.jerked), truth.saturated != 0});
  tip_.push_back(sample);
}

void TrialJudge::take(const retina_pose_t& pose, std::int64_t utime)
{
  newest_frame_ = pose.tracked ? pose.utime : newest_frame_;
  const auto frame = frames_.find(pose.frame);
  if (!first_frame_ && frame != frames_.end()) first_frame_ = frame->second.truth;  // the tracker's map begins there
  if (frame != frames_.end()) ++poses_;
  if (!counts() || frame == frames_.end()) return;
  ++frames_seen_;
  pose_ages_s_.push_back(kMicro * static_cast<double>(utime - pose.utime));
  if (!pose.tracked) return tip_judge_->spoilt(time(pose.utime));
  ++frames_tracked_;
  frame->second.seen = poseOf(pose.x_px, pose.y_px, pose.theta, pose.scale);
}

void TrialJudge::take(const servo_status_t& status)
{
  const bool changed = !has_status_ || status.state != status_.state;
  if (counts() && status.frame_to_command >= 0.0) frame_to_command_s_.push_back(status.frame_to_command);
  if (counts() && status.computation > 0.0) computation_s_.push_back(status.computation);
  has_status_ = true;
  status_ = status;
  if (!changed || over_ || !setting_) return;  // a servo that is there before the trial has a state then, too
  const bool stands = status.state == servo_status_t::HOLD || status.state == servo_status_t::FAULT;
  if (counts()) (status.state == servo_status_t::HOLD ? holds_ : faults_) += stands ? 1 : 0;
  const double t_s = counts_from_ ? time(status.utime) : kMicro * static_cast<double>(status.utime - start_.utime);
  events_.push_back({t_s, std::string(messaging::word(static_cast<messaging::ServoState>(status.state))),
                     wordOf(status.reason), stands && setting_ && setting_->scenario.fault.must == "go_on"});
}

void TrialJudge::take(const burn_plan_t& plan)
{
  if (plan.state == burn_plan_t::IN_FORCE) plan_ = plan;
}

void TrialJudge::take(const vessel_map_t& tile)
{
  vessel_map_t checked{};
  if (setting_ && messaging::read(tile, checked) == retina::Reason::none) maps_.add(checked);
}

// What the laser itself cannot know: that somebody allowed it.
bool TrialJudge::mayEmit() const
{
  if (!laser_.foot_switch || !laser_.armed || !laser_.interlock_closed) return false;
  return setting_->scenario.isManual() || (status_.state == servo_status_t::LASER && wish_.arm);
}

void TrialJudge::followPulse(const truth_t& truth)
{
  const bool begins = truth.emitting && (!emitting_ || pulses_.back().number != laser_.pulse);
  emitting_ = truth.emitting != 0;
  if (!emitting_) return;
  if (begins) {
    const std::int64_t newest = setting_->scenario.isManual() ? truth.frame_utime : newest_frame_;
    Pulse pulse;
    pulse.target = laser_.target;
    pulse.number = laser_.pulse;
    pulse.begin = truth.utime;
    pulse.newest_frame = newest;
    pulses_.push_back(pulse);
    if (!mayEmit()) ++violations_;
  }
  Pulse& pulse = pulses_.back();
  pulse.end = truth.utime;
  pulse.steps += 1.0;
  pulse.spot += (Eigen::Vector2d(truth.spot) - pulse.spot) / pulse.steps;
  pulse.way.extend(Eigen::Vector2d(truth.spot));
}

Eigen::Vector2d TrialJudge::ontoRetina(double x_px, double y_px) const
{
  const double px = kMicro * um_per_px_;
  const Eigen::Vector2d map_px(x_px, y_px), centre = scene_->middle().head<2>() / px;
  const bool own_map = !setting_->scenario.isManual() && first_frame_;  // a tracker's begins with its first frame
  return px * (own_map ? Eigen::Vector2d(centre + *first_frame_ * (map_px - centre)) : map_px);
}

Eigen::Vector2d TrialJudge::ontoMap(const Eigen::Vector2d& retina_px) const
{
  const Eigen::Vector2d centre = scene_->middle().head<2>() / (kMicro * um_per_px_);
  return centre + first_frame_->inverse() * (retina_px - centre);
}

const simulation::RetinaPose& TrialJudge::retinaAt(std::int64_t utime) const
{
  const std::int64_t step = (utime - first_truth_ + kPeriod_us / 2) / kPeriod_us;
  return retina_[static_cast<std::size_t>(
      std::clamp<std::int64_t>(step, 0, static_cast<std::int64_t>(retina_.size()) - 1))];
}

PulseRecord TrialJudge::recordOf(const Pulse& pulse) const
{
  PulseRecord record;
  record.t_s = time(pulse.end);
  record.target = pulse.target;
  record.spot = record.wanted = pulse.spot;
  record.duration = kMicro * static_cast<double>(pulse.end - pulse.begin + kPeriod_us);
  double burn = 0.0;
  for (const burn_target_t& target : plan_->target) {
    if (target.id != pulse.target) continue;
    record.wanted = ontoRetina(target.x_px, target.y_px);
    burn = kMicro * target.burn_um;
  }
  record.length = burn + pulse.way.diagonal().norm();
  record.placement = (record.spot - record.wanted).norm();
  record.clearance = scene_->vesselDistance(pulse.spot) - 0.5 * burn;
  record.touched_calibre = scene_->widestWithin(pulse.spot, 0.5 * burn);
  record.far = record.placement > kFarOff;
  const Eigen::Vector3d wanted(record.wanted.x(), record.wanted.y(), 0.0);
  const Eigen::Vector3d moved = retinaAt(pulse.end).toWorld(wanted) - retinaAt(pulse.newest_frame).toWorld(wanted);
  record.explained = record.far && moved.head<2>().norm() > kMoved;
  return record;
}

}  // namespace eyeslam::trials
