// SPDX-License-Identifier: GPL-3.0-or-later
// The second half of TrialJudge: what it has seen, as a record.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "eyeslam/retina/reason.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/trials/error_figures.h"
#include "eyeslam/trials/trial_judge.h"

namespace eyeslam::trials {

namespace {

constexpr double kOnPath = 50e-6;       // m, that counts as having been there
constexpr double kNotices_s = 0.5;      // the longest of the servo's patiences is 0.3 s
constexpr double kHalfSize_px = 400.0;  // width of the half-size picture, which a smaller frame is already
constexpr const char* kFates[] = {"pending", "done", "missed", "refused"};  // burn_target_t

double share(std::size_t part, std::size_t whole)
{
  return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
}

double mean(const std::vector<double>& values)
{
  return values.empty() ? 0.0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Standard deviation, of the values themselves.
double spread(const std::vector<double>& values)
{
  const double middle = mean(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - middle) * (value - middle);
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

template <class Of, class Values>
std::vector<double> each(const Values& values, const Of& of)
{
  std::vector<double> result;
  std::transform(values.begin(), values.end(), std::back_inserter(result), of);
  return result;
}

void addLatency(const std::string& what, const std::vector<double>& seconds, TrialScore& score)
{
  if (seconds.empty()) return;
  const ErrorFigures figures = errorFigures(seconds);
  score.more.emplace_back(what + "_median_ms", 1e3 * figures.median);
  score.more.emplace_back(what + "_p95_ms", 1e3 * figures.p95);
}

// Which part of the path the tip came near to.
double coverage(const std::vector<Eigen::Vector3d>& path, const std::vector<TipSample>& tip)
{
  const auto reached = static_cast<std::size_t>(std::count_if(path.begin(), path.end(), [&tip](const auto& place) {
    return std::any_of(tip.begin(), tip.end(), [&place](const TipSample& sample) {
      return std::hypot(sample.tip.x() - place.x(), sample.tip.y() - place.y()) <= kOnPath;
    });
  }));
  return share(reached, path.size());
}

/// What the fault must bring about, in time.
bool isDue(const TrialEvent& event, const ScenarioFaultOptions& fault)
{
  const bool in_time = event.t_s >= fault.at_s && event.t_s <= fault.at_s + kNotices_s;
  return in_time && event.what == fault.must && (fault.reason.empty() || event.reason == fault.reason);
}

/// A stop that the fault does not account for; on the way to a fault there may be a hold.
bool isUndue(const TrialEvent& event, const ScenarioFaultOptions& fault)
{
  if (event.t_s < 0.0 || (event.what != "hold" && event.what != "fault")) return false;  // not yet counted, or no stop
  const bool meanwhile = event.t_s >= fault.at_s && event.t_s <= fault.at_s + fault.for_s + kNotices_s;
  return !meanwhile || (event.what == "fault" && fault.must == "hold");
}

}  // namespace

TrialRecord TrialJudge::record() const
{
  if (!setting_) throw std::logic_error("the log has no MARK START of a trial");
  const Scenario& scenario = setting_->scenario;
  TrialRecord record;
  record.task = scenario.task;
  record.variant = name_.variant;
  record.configuration = start_.configuration;
  record.retina = scene_->picture();
  for (const Eigen::Vector3d& place : scene_->path()) record.path.emplace_back(place.head<2>());
  record.events = events_;
  record.whole = over_;
  record.pose_ages_s = pose_ages_s_;
  record.frame_to_command_s = frame_to_command_s_;
  record.computation_s = computation_s_;
  record.fastest_tip = fastest_tip_;
  record.worst_pivot = worst_pivot_;
  record.frames = frames_seen_;
  record.tracked = frames_tracked_;
  if (poses_ > 0) record.left_out = 1.0 - share(static_cast<std::size_t>(poses_), frames_.size());

  TrialScore& score = record.score;
  score.scenario = name_.scenario;
  score.seed = name_.seed;
  score.aid = scenario.aid;
  score.motion = scenario.motion;
  score.condition = scenario.condition;
  score.retina = scenario.retina;
  score.camera_hz = scenario.camera_hz;
  score.latency_ms = scenario.latency_ms;
  score.version = start_.version;
  score.config_hash = start_.configuration_hash;
  score.hold_events = holds_;
  score.fault_events = faults_;
  score.duration_s = 1e-3 * static_cast<double>(truths_);
  score.saturated_fraction = share(static_cast<std::size_t>(saturated_), static_cast<std::size_t>(truths_));
  score.tip_travel_mm = 1e3 * std::accumulate(travelled_.begin(), travelled_.end(), 0.0);
  if (!travelled_.empty())
    score.more.emplace_back("highest_tip_speed_mm_s", 1e6 * *std::max_element(travelled_.begin(), travelled_.end()));
  score.more.emplace_back("hand_travel_mm", 1e3 * hand_travelled_);
  score.more.emplace_back("tip_off_hand_rms_um", errorFigures(hand_off_um_).rms);
  addLatency("pose_age", pose_ages_s_, score);
  addLatency("frame_to_command", frame_to_command_s_, score);
  if (scenario.isLaser()) {
    addTargets(record);
    addPulses(record);
  } else {
    addTip(record);
  }
  addPoses(record);
  addMap(record);
  addVerdict(record);
  return record;
}

void TrialJudge::addTip(TrialRecord& record) const
{
  const TipErrors errors = tip_judge_->result();
  record.tip = tip_;
  record.jumps = errors.jumps;
  for (std::size_t i = 0; i < std::min(record.tip.size(), errors.calm.size()); ++i) record.tip[i].calm = errors.calm[i];
  if (tip_.empty()) return;
  const std::vector<double> um = each(tip_, [](const TipSample& sample) { return sample.error / kMicro; });
  const ErrorFigures figures = errorFigures(um);
  TrialScore& score = record.score;
  score.mean_um = mean(um);
  score.rms_um = figures.rms;
  score.median_um = figures.median;
  score.p95_um = figures.p95;
  score.max_um = figures.max;
  if (scene_->path().size() > 1) score.path_coverage = coverage(scene_->path(), tip_);
  std::vector<double> calm, on_path, calm_on_path;
  for (const TipSample& sample : record.tip) {
    const double error_um = sample.error / kMicro;
    if (sample.calm) calm.push_back(error_um);
    if (sample.on_path) on_path.push_back(error_um);
    if (sample.calm && sample.on_path) calm_on_path.push_back(error_um);
  }
  score.more.emplace_back("calm_rms_um", errorFigures(calm).rms);
  score.more.emplace_back("calm_p99_um", errorFigures(calm).p99);
  score.more.emplace_back("calm_on_path_rms_um", errorFigures(calm_on_path).rms);
  score.more.emplace_back("calm_on_path_p99_um", errorFigures(calm_on_path).p99);
  if (record.task != "trace") return;
  score.more.emplace_back("beyond_path_share", 1.0 - share(on_path.size(), record.tip.size()));
  score.more.emplace_back("on_path_rms_um", errorFigures(on_path).rms);
  score.more.emplace_back("on_path_p95_um", errorFigures(on_path).p95);
}

void TrialJudge::addPoses(TrialRecord& record) const
{
  if (frames_seen_ == 0 || !first_frame_) return;
  const double half_size = kHalfSize_px / setting_->hardware.camera.width;
  std::vector<double> degrees;
  for (const auto& [number, frame] : frames_) {
    if (!frame.seen) continue;
    const retina::Pose2 error = (first_frame_->inverse() * frame.truth).inverse() * *frame.seen;
    record.pose_errors_px.push_back(half_size * error.translation().norm());
    degrees.push_back(std::abs(kDegreesPerRadian * error.theta));
  }
  record.score.tracked_fraction =
      share(static_cast<std::size_t>(frames_tracked_), static_cast<std::size_t>(frames_seen_));
  record.score.pose_rms_px = errorFigures(record.pose_errors_px).rms;
  record.score.pose_rms_deg = errorFigures(degrees).rms;
}

// As it is at the end; a plan is judged anew by each that comes.
void TrialJudge::addMap(TrialRecord& record) const
{
  if (!first_frame_ || maps_.map().empty()) return;
  record.map = compareMap(maps_.map(), scene_->trueMap(), [this](const Eigen::Vector2d& px) { return ontoMap(px); });
  for (std::size_t kind = 0; kind < kCalibreClasses.size(); ++kind)
    if (record.map.coverage[kind])
      record.score.more.emplace_back(std::string("map_coverage_") + kCalibreClasses[kind], *record.map.coverage[kind]);
  if (record.map.precision) record.score.more.emplace_back("map_precision", *record.map.precision);
}

void TrialJudge::addTargets(TrialRecord& record) const
{
  if (!plan_) return;
  for (const burn_target_t& target : plan_->target) {
    const std::string reason =
        target.reason == 0 ? "" : std::string(retina::word(static_cast<retina::Reason>(target.reason)));
    record.targets.push_back({target.id, ontoRetina(target.x_px, target.y_px), kMicro * target.burn_um,
                              kFates[std::clamp<int>(target.state, 0, 3)], reason});
  }
}

void TrialJudge::addPulses(TrialRecord& record) const
{
  TrialScore& score = record.score;
  const auto fated = [&record](const char* fate) {
    return std::count_if(record.targets.begin(), record.targets.end(),
                         [fate](const PlannedTarget& target) { return target.fate == fate; });
  };
  score.targets = static_cast<std::int64_t>(record.targets.size());
  score.refused = fated("refused");
  score.missed = fated("missed");
  std::map<std::string, double> reasons;
  for (const PlannedTarget& target : record.targets)
    if (target.fate == "refused" || target.fate == "missed")
      ++reasons[target.fate + (target.reason.empty() ? "" : "_" + target.reason)];
  for (const auto& [reason, count] : reasons) score.more.emplace_back(reason, count);
  score.fired = static_cast<std::int64_t>(pulses_.size());
  score.interlock_violations = violations_;
  score.far_pulses = score.far_unexplained = 0;
  if (!plan_ || pulses_.empty()) return;
  for (const Pulse& pulse : pulses_) record.pulses.push_back(recordOf(pulse));
  const ErrorFigures placement =
      errorFigures(each(record.pulses, [](const PulseRecord& pulse) { return pulse.placement / kMicro; }));
  score.placement_mean_um = mean(each(record.pulses, [](const PulseRecord& p) { return p.placement / kMicro; }));
  score.placement_p95_um = placement.p95;
  score.placement_max_um = placement.max;
  score.min_vessel_clearance_um = record.pulses.front().clearance / kMicro;
  for (const PulseRecord& pulse : record.pulses) {
    *score.far_pulses += pulse.far ? 1 : 0;
    *score.far_unexplained += pulse.far && !pulse.explained ? 1 : 0;
    score.min_vessel_clearance_um = std::min(*score.min_vessel_clearance_um, pulse.clearance / kMicro);
  }
  const double took_s = record.pulses.back().t_s - record.pulses.front().t_s;
  if (took_s > 0.0) score.burns_per_s = static_cast<double>(pulses_.size() - 1) / took_s;
  const std::vector<double> lengths = each(record.pulses, [](const PulseRecord& p) { return p.length / kMicro; });
  score.more.emplace_back("burn_length_mean_um", mean(lengths));
  score.more.emplace_back("burn_length_spread_um", spread(lengths));
  score.more.emplace_back("waited_for_first_burn_s", record.pulses.front().t_s);
  for (std::size_t kind = 0; kind < kCalibreClasses.size(); ++kind) {
    const auto touching = std::count_if(record.pulses.begin(), record.pulses.end(), [kind](const PulseRecord& pulse) {
      return pulse.touched_calibre > 0.0 && calibreClass(pulse.touched_calibre) == kind;
    });
    score.more.emplace_back(std::string("burns_on_vessels_") + kCalibreClasses[kind], static_cast<double>(touching));
  }
}

void TrialJudge::addVerdict(TrialRecord& record) const
{
  const ScenarioFaultOptions& fault = setting_->scenario.fault;
  if (never_began_ || counts_from_ == 0) {
    record.passed = false;
    record.verdict = "what was asked for never began";
    return;
  }
  if (fault.kind == "none") return;
  record.verdict = fault.kind + ": must " + fault.must + (fault.reason.empty() ? "" : " with " + fault.reason);
  if (fault.must == "go_on") {
    record.passed = holds_ + faults_ == 0;
    record.verdict += *record.passed ? "; it did" : "; it did not";
    return;
  }
  const bool did =
      std::any_of(events_.begin(), events_.end(), [&](const TrialEvent& event) { return isDue(event, fault); });
  const auto undue =
      std::find_if(events_.begin(), events_.end(), [&](const TrialEvent& event) { return isUndue(event, fault); });
  record.passed = did && undue == events_.end();
  record.verdict += did ? "; it did" : "; it did not in time";
  if (undue != events_.end())
    record.verdict +=
        fmt::format("; but {} ({}) at {:.2f} s is none of its doing", undue->what, undue->reason, undue->t_s);
}

}  // namespace eyeslam::trials
