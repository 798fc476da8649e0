// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eyeslam/trials/jump_recovery.h"
#include "eyeslam/trials/map_coverage.h"
#include "eyeslam/trials/trial_score.h"

namespace eyeslam::trials {

/// One millisecond of a trial, by the truth; retina frame, m.
struct TipSample {
  double t_s = 0.0;  ///< since the part that counts began
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  double error = 0.0;   ///< m, >= 0: how far from right
  bool calm = true;     ///< not within 150 ms of fast motion of the retina
  bool on_path = true;  ///< beside what is to be followed, not beyond an end of it
};

/// A pulse that was really emitted; retina frame, m.
struct PulseRecord {
  double t_s = 0.0;  ///< when it ended, since the part that counts began
  int target = -1;   ///< id in the plan
  Eigen::Vector2d wanted = Eigen::Vector2d::Zero(), spot = Eigen::Vector2d::Zero();  ///< mean over the pulse
  double placement = 0.0;                                                            ///< m, between both
  double duration = 0.0;                                                             ///< s
  double length = 0.0;         ///< m, of the burn: its diameter, drawn out by the spot's way during the pulse
  double clearance = 0.0;      ///< m, its edge to the nearest true vessel's edge; negative: they touch
  double touched_calibre = 0;  ///< m, of the widest true vessel that its disc touches; 0: none
  bool far = false;            ///< more than 60 um off
  bool explained = false;      ///< the retina moved more than 40 um between the newest frame and the pulse's end
};

/// A target of the plan in force, and what became of it.
struct PlannedTarget {
  int id = 0;
  Eigen::Vector2d wanted = Eigen::Vector2d::Zero();  ///< retina frame, m
  double burn = 0.0;                                 ///< m, diameter
  std::string fate, reason;                          ///< done, missed, refused, pending
};

/// A change of the servo's state, or another thing that happened.
struct TrialEvent {
  double t_s = 0.0;
  std::string what, reason;  ///< "hold", "operator_silent"
  bool warning = false;      ///< belongs on top of the report
};

/// The true retina as a picture, and where it lies: retina frame (m) = origin + px * m_per_px.
struct RetinaPicture {
  cv::Mat bgr;                    ///< 8 bit, 3 channels
  cv::Mat_<std::uint8_t> vessel;  ///< 255 = a true vessel; same size
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  double m_per_px = 0.0;
};

/// All that a report shows of one trial; made from its log.
struct TrialRecord {
  TrialScore score;
  std::string variant;        ///< the swept values, "aid=hard"; empty where nothing is swept
  std::string task;           ///< trace, hold, laser, standoff
  std::string configuration;  ///< whole, as YAML
  RetinaPicture retina;
  std::vector<Eigen::Vector2d> path;  ///< what was to be traced, retina frame, m; of hold the place alone
  std::vector<TipSample> tip;         ///< a sample a millisecond; empty of laser trials
  std::vector<Jump> jumps;            ///< jerks and saccades, and when the tip was back; empty of laser trials
  std::vector<PulseRecord> pulses;
  std::vector<PlannedTarget> targets;
  MapCoverage map;  ///< of the map at the end; empty where nothing mapped
  std::vector<TrialEvent> events;
  bool whole = true;                       ///< the log has the trial's end: not of one that was cut off
  double fastest_tip = 0.0;                ///< m/s, from the start, calibration included
  double worst_pivot = 0.0;                ///< m, of the shaft from the commanded centre of motion
  std::int64_t frames = 0, tracked = 0;    ///< whose poses came
  double left_out = 0.0;                   ///< [0, 1], of all frames: no pose came, for the tracker had no time
  std::vector<double> pose_errors_px;      ///< half-resolution px, a tracked frame each
  std::vector<double> pose_ages_s;         ///< of the newest pose at its arrival, since mid-exposure
  std::vector<double> frame_to_command_s;  ///< mid-exposure to the first command that uses it
  std::vector<double> computation_s;       ///< CPU time of the longest cycle of each status; empty in lock step
  std::optional<bool> passed;              ///< of scenarios that say what must happen
  std::string verdict;                     ///< what was to happen, and what did
};

}  // namespace eyeslam::trials
