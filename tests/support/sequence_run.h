// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "eyeslam/files/score.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/track_result.h"

namespace eyeslam::support {

/// What a tracker said about a sequence, beside the truth: an element a frame.
struct SequenceRun {
  std::vector<files::TruthPose> truth;
  std::vector<files::EstimatedPose> estimate;
  std::vector<Eigen::Matrix3d> covariance;  ///< full px, rad

  void add(const files::TruthPose& truth_pose, const tracking::TrackResult& result)
  {
    const retina::Pose2& pose = result.map_T_frame;
    truth.push_back(truth_pose);
    estimate.push_back({result.tracked, pose.x, pose.y, pose.theta * 180.0 / M_PI, 0.0});
    covariance.push_back(result.covariance);
  }

  files::PoseScore score() const { return files::scorePoses(truth, estimate); }

  /// e' C^-1 e, mean over the frames tracked, after the first (which is exact by definition). Median error removed, for
  /// frame 0's own error is the same in all frames. 3 is perfect.
  double normalisedSquaredError() const
  {
    std::vector<Eigen::Vector3d> errors;
    std::vector<Eigen::Matrix3d> covariances;
    for (std::size_t i = 1; i < truth.size(); ++i) {
      if (!truth[i].visible || !estimate[i].tracked) continue;
      const double turn = retina::wrapAngle((estimate[i].theta_deg - truth[i].theta_deg) * M_PI / 180.0);
      errors.emplace_back(estimate[i].x_px - truth[i].x_px, estimate[i].y_px - truth[i].y_px, turn);
      covariances.push_back(covariance[i]);
    }
    Eigen::Vector3d offset;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (const Eigen::Vector3d& error : errors) values.push_back(error[axis]);
      offset[axis] = files::percentile(values, 50.0);
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const Eigen::Vector3d error = errors[i] - offset;
      sum += error.dot(covariances[i].inverse() * error);
    }
    return sum / static_cast<double>(errors.size());
  }
};

}  // namespace eyeslam::support
