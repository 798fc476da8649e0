// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/files/log_event.h"
#include "eyeslam/laser_state_t.hpp"
#include "eyeslam/mark_t.hpp"
#include "eyeslam/messaging/map_assembler.h"
#include "eyeslam/operator_t.hpp"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/retina_pose_t.hpp"
#include "eyeslam/servo_status_t.hpp"
#include "eyeslam/simulation/retina_pose.h"
#include "eyeslam/trials/tip_judge.h"
#include "eyeslam/trials/trial.h"
#include "eyeslam/trials/trial_record.h"
#include "eyeslam/trials/trial_scene.h"
#include "eyeslam/truth_t.hpp"

namespace eyeslam::trials {

/// Scores a trial from the messages of its log alone, by the simulation's truth in it: the same for lock step, real
/// processes and old logs. What it takes is in order of sending.
///
///   TrialJudge judge;
///   for each event: judge.take(event);
///   const TrialRecord record = judge.record();
class TrialJudge {
 public:
  TrialJudge() = default;
  /// @param scene  of the log's setting and seed, where somebody has it already: it takes half a second to make
  explicit TrialJudge(std::shared_ptr<const TrialScene> scene) : scene_(std::move(scene)) {}

  /// Other people's channels, and what cannot be decoded, are passed over.
  /// @throws configuration::ConfigurationError, files::FileError  the log's MARK START cannot be followed
  void take(const files::LogEvent& event);

  /// Whether MARK START of a trial has come.
  bool isTrial() const { return setting_.has_value(); }
  /// @throws std::logic_error where isTrial() is false
  TrialRecord record() const;

 private:
  struct Pulse {
    int target = -1;
    std::int64_t number = 0, begin = 0, end = 0, newest_frame = 0;
    Eigen::Vector2d spot = Eigen::Vector2d::Zero();
    double steps = 0.0;
    Eigen::AlignedBox2d way;  // of the spot over the retina
  };
  struct SeenFrame {
    retina::Pose2 truth;
    std::optional<retina::Pose2> seen;
  };

  void take(const mark_t& mark);
  void countFrom(std::int64_t utime);
  void take(const truth_t& truth);
  void take(const retina_pose_t& pose, std::int64_t utime);
  void take(const servo_status_t& status);
  void take(const burn_plan_t& plan);
  void take(const vessel_map_t& tile);
  void rememberRetina(const simulation::RetinaPose& retina, std::int64_t utime);
  void watchSpeed(const truth_t& truth);
  void judgeTip(const truth_t& truth);
  void followPulse(const truth_t& truth);
  bool mayEmit() const;
  TipSample sampleOf(const Eigen::Vector3d& tip, double t_s);
  double time(std::int64_t utime) const { return 1e-6 * static_cast<double>(utime - counts_from_); }
  bool counts() const { return counts_from_ != 0 && !over_; }

  Eigen::Vector2d ontoRetina(double x_px, double y_px) const;
  Eigen::Vector2d ontoMap(const Eigen::Vector2d& retina_px) const;
  const simulation::RetinaPose& retinaAt(std::int64_t utime) const;
  void addPulses(TrialRecord& record) const;
  PulseRecord recordOf(const Pulse& pulse) const;
  void addTargets(TrialRecord& record) const;
  void addTip(TrialRecord& record) const;
  void addPoses(TrialRecord& record) const;
  void addMap(TrialRecord& record) const;
  void addVerdict(TrialRecord& record) const;

  std::shared_ptr<const TrialScene> scene_;  // shared with who made it
  std::optional<TrialSetting> setting_;
  TrialName name_;
  mark_t start_{};
  std::int64_t counts_from_ = 0;
  bool over_ = false, never_began_ = false;

  std::optional<TipJudge> tip_judge_;
  std::vector<TipSample> tip_;
  std::vector<double> travelled_;
  std::optional<Eigen::Vector3d> last_null_;
  std::vector<double> hand_off_um_;  // the tip from where the hand alone would have it
  double hand_travelled_ = 0.0;      // m
  std::int64_t saturated_ = 0, truths_ = 0;
  std::int64_t first_truth_ = 0;
  std::vector<simulation::RetinaPose> retina_;  // a millisecond each, from first_truth_ on
  double um_per_px_ = 0.0;
  std::optional<Eigen::Vector3d> last_tip_, last_world_tip_;
  bool beyond_path_ = false;                      // over an end of it, and not back yet
  double fastest_tip_ = 0.0, worst_pivot_ = 0.0;  // m/s, m

  std::map<std::int64_t, SeenFrame> frames_;
  std::optional<retina::Pose2> first_frame_;
  std::int64_t poses_ = 0;  // of all frames; the others count only what is scored
  std::int64_t frames_seen_ = 0, frames_tracked_ = 0, newest_frame_ = 0;
  std::vector<double> pose_ages_s_, frame_to_command_s_, computation_s_;

  servo_status_t status_{};
  bool has_status_ = false;
  laser_state_t laser_{};
  operator_t wish_{};
  std::vector<TrialEvent> events_;
  std::int64_t holds_ = 0, faults_ = 0, violations_ = 0;
  std::vector<Pulse> pulses_;
  bool emitting_ = false;
  std::optional<burn_plan_t> plan_;
  messaging::MapAssembler maps_;
};

}  // namespace eyeslam::trials
