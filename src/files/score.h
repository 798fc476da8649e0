// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "eyeslam/files/truth.h"

namespace eyeslam::files {

/// One row of a trajectory as far as the score reads it; full-resolution px, deg.
struct EstimatedPose {
  bool tracked = false;
  double x_px = 0.0;
  double y_px = 0.0;
  double theta_deg = 0.0;
  double cpu_ms = 0.0;
};

/// A frame's error: where the image centre was put against where it was, half-resolution px and deg.
struct PoseError {
  double x_px = 0.0;
  double y_px = 0.0;
  double distance_px = 0.0;
  double theta_deg = 0.0;  ///< wrapped to [-180, 180)
};

/// How well a trajectory follows the truth, over the frames in which the retina is visible. An untracked frame counts
/// with the pose that it repeats. Lengths in half-resolution px at the image centre; fractions in [0, 1].
struct PoseScore {
  int frames = 0;
  int visible = 0;
  double rms_px = 0.0;
  double rms_deg = 0.0;
  double aligned_rms_px = 0.0;  ///< with the median error removed: frame 0's own error is the same in all frames
  double aligned_rms_deg = 0.0;
  double median_px = 0.0;
  double p95_px = 0.0;
  double max_px = 0.0;
  double under_5_px = 0.0;
  double tracked = 0.0;
  double tracked_while_hidden = 0.0;  ///< share of the hidden frames that were claimed all the same
  std::vector<int> frames_to_return;  ///< for each return of the view: frames until under 5 px; -1 = never
  double cpu_ms_median = 0.0;
  double cpu_ms_p99 = 0.0;
};

/// Beyond this a frame does not count as followed; half-resolution px.
constexpr double kLost_px = 5.0;

PoseError poseError(const TruthPose& truth, const EstimatedPose& estimate);

/// Scores a trajectory with a row for each frame of the truth.
/// @throws std::invalid_argument when the lengths differ, no frame is visible, or a value is not finite
PoseScore scorePoses(const std::vector<TruthPose>& truth, const std::vector<EstimatedPose>& estimate);

/// The value below which `percent` of the values lie, interpolated linearly between neighbours; needs one value.
double percentile(std::vector<double> values, double percent);

}  // namespace eyeslam::files
