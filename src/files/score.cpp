// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/score.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace eyeslam::files {
namespace {

double rootMeanSquare(const std::vector<double>& values)
{
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double wrapDegrees(double angle_deg) { return angle_deg - 360.0 * std::floor((angle_deg + 180.0) / 360.0); }

void check(const std::vector<TruthPose>& truth, const std::vector<EstimatedPose>& estimate)
{
  if (truth.size() != estimate.size()) {
    throw std::invalid_argument("the trajectory has " + std::to_string(estimate.size()) + " rows, the sequence " +
                                std::to_string(truth.size()) + " frames: a row a frame, from 0, is wanted");
  }
  if (std::none_of(truth.begin(), truth.end(), [](const TruthPose& pose) { return pose.visible; })) {
    throw std::invalid_argument("the truth has no visible frame: nothing can be scored");
  }
  for (const EstimatedPose& pose : estimate) {
    if (!std::isfinite(pose.x_px) || !std::isfinite(pose.y_px) || !std::isfinite(pose.theta_deg)) {
      throw std::invalid_argument("the trajectory holds values that are not finite");
    }
  }
}

/// The errors of the visible frames, one list a component.
struct ErrorLists {
  std::vector<double> x, y, distance, theta;
};

ErrorLists visibleErrors(const std::vector<TruthPose>& truth, const std::vector<EstimatedPose>& estimate)
{
  ErrorLists lists;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!truth[i].visible) continue;
    const PoseError error = poseError(truth[i], estimate[i]);
    lists.x.push_back(error.x_px);
    lists.y.push_back(error.y_px);
    lists.distance.push_back(error.distance_px);
    lists.theta.push_back(error.theta_deg);
  }
  return lists;
}

void scoreWithoutOffset(const ErrorLists& errors, PoseScore& score)
{
  const double x = percentile(errors.x, 50.0), y = percentile(errors.y, 50.0), theta = percentile(errors.theta, 50.0);
  std::vector<double> distance, turn;
  for (std::size_t i = 0; i < errors.x.size(); ++i) {
    distance.push_back(std::hypot(errors.x[i] - x, errors.y[i] - y));
    turn.push_back(errors.theta[i] - theta);
  }
  score.aligned_rms_px = rootMeanSquare(distance);
  score.aligned_rms_deg = rootMeanSquare(turn);
}

void countFrames(const std::vector<TruthPose>& truth, const std::vector<EstimatedPose>& estimate, PoseScore& score)
{
  int tracked = 0, hidden = 0, claimed = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    (truth[i].visible ? score.visible : hidden) += 1;
    if (estimate[i].tracked) (truth[i].visible ? tracked : claimed) += 1;
  }
  score.frames = static_cast<int>(truth.size());
  score.tracked = static_cast<double>(tracked) / score.visible;
  score.tracked_while_hidden = hidden ? static_cast<double>(claimed) / hidden : 0.0;
}

int framesUntilFollowed(const std::vector<TruthPose>& truth, const std::vector<EstimatedPose>& estimate,
                        std::size_t first)
{
  for (std::size_t i = first; i < truth.size(); ++i) {
    if (poseError(truth[i], estimate[i]).distance_px < kLost_px) return static_cast<int>(i - first);
  }
  return -1;
}

void scoreTime(const std::vector<EstimatedPose>& estimate, PoseScore& score)
{
  std::vector<double> cpu_ms;
  cpu_ms.reserve(estimate.size());
  for (const EstimatedPose& pose : estimate) cpu_ms.push_back(pose.cpu_ms);
  score.cpu_ms_median = percentile(cpu_ms, 50.0);
  score.cpu_ms_p99 = percentile(cpu_ms, 99.0);
}

}  // namespace

PoseError poseError(const TruthPose& truth, const EstimatedPose& estimate)
{
  const double x = (estimate.x_px - truth.x_px) / 2.0, y = (estimate.y_px - truth.y_px) / 2.0;
  return {x, y, std::hypot(x, y), wrapDegrees(estimate.theta_deg - truth.theta_deg)};
}

PoseScore scorePoses(const std::vector<TruthPose>& truth, const std::vector<EstimatedPose>& estimate)
{
  check(truth, estimate);
  const ErrorLists errors = visibleErrors(truth, estimate);
  PoseScore score;
  countFrames(truth, estimate, score);
  score.rms_px = rootMeanSquare(errors.distance);
  score.rms_deg = rootMeanSquare(errors.theta);
  scoreWithoutOffset(errors, score);
  score.median_px = percentile(errors.distance, 50.0);
  score.p95_px = percentile(errors.distance, 95.0);
  score.max_px = percentile(errors.distance, 100.0);
  const auto followed = std::count_if(errors.distance.begin(), errors.distance.end(),
                                      [](double distance_px) { return distance_px < kLost_px; });
  score.under_5_px = static_cast<double>(followed) / score.visible;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    if (!truth[i - 1].visible && truth[i].visible) {
      score.frames_to_return.push_back(framesUntilFollowed(truth, estimate, i));
    }
  }
  scoreTime(estimate, score);
  return score;
}

double percentile(std::vector<double> values, double percent)
{
  std::sort(values.begin(), values.end());
  const double rank = percent / 100.0 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (rank - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace eyeslam::files
