// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/error_figures.h"
#include "eyeslam/trials/loop_trial.h"

namespace eyeslam::trials {

/// @param motion  paper, in_situ, jerky, saccade
/// @param camera  30/20 or 120/5: frames a second / ms at most from mid-exposure to pose; true: the true pose each ms
/// @throws std::invalid_argument naming the word
LoopTrialSetting loopSetting(const std::string& motion, const std::string& camera);

/// A part of the loop left out, and what the loop study found then (section 4; hold in situ, RMS um; 0: not given).
struct LeftOut {
  std::string part;
  void (*leaveOut)(LoopTrialSetting& setting);
  double study_30_20_um = 0.0;
  double study_120_5_um = 0.0;
};
const std::vector<LeftOut>& leftOut();

/// What a tip needs to be back after a jump.
struct RecoveryTiming {
  double latency_s = 0.0;  ///< longest from mid-exposure to the pose
  double frame_s = 0.0;
  double speed = 0.0;  ///< of the goal, m/s
};
RecoveryTiming recoveryTiming(const LoopTrialSetting& setting);

/// Within which time from a jump's onset the tip must be back: latency + frame + way / goal speed + 40 ms (issue 16).
double recoveryDeadline(const RecoveryTiming& timing, const Jump& jump);

/// Saccades whose recovery was looked at.
struct RecoveryCount {
  int jumps = 0, in_time = 0;        ///< all but those that another one disturbed
  int whole = 0, whole_in_time = 0;  ///< of these, without a refused or wrong frame
  std::vector<double> seconds;       ///< until the tip was back
};
void countRecoveries(const RecoveryTiming& timing, const std::vector<Jump>& jumps, RecoveryCount& count);

/// The tip after a step of its goal on a still retina, without tremor and noise.
struct StepResponse {
  double overshoot = 0.0;  ///< share of the step
  double late_s = 0.0;     ///< within 5 % for good, later than step / goal speed
};
/// @param step  m; @param speed_mm_s  of the goal
StepResponse stepResponse(double step, double speed_mm_s);

}  // namespace eyeslam::trials
