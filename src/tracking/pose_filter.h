// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/match_result.h"

namespace eyeslam::tracking {

struct PoseFilterOptions {
  double acceleration_px = 1.5;
  double acceleration_deg = 0.17;
  double scale_walk = 0.002;
  double scale_noise = 0.001;
  double jump_gate = 50.0;
  double coast_fade = 0.7;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("acceleration_px", self.acceleration_px, Range{0.001, 100.0}, "frame px per frame^2",
                  "white acceleration of the eye, one sigma; source: tracker study 2.7");
    visitor.field("acceleration_deg", self.acceleration_deg, Range{0.001, 45.0}, "deg per frame^2",
                  "white angular acceleration of the eye, one sigma; source: tracker study 2.7");
    visitor.field("scale_walk", self.scale_walk, Range{0.0, 0.1}, "per frame",
                  "random walk of the magnification, one sigma; source: tracker study 2.12 (deform needs 0.0018)");
    visitor.field("scale_noise", self.scale_noise, Range{1e-6, 0.1}, "",
                  "error of a measured magnification, one sigma; source: a tenth of a cell at the view's edge");
    visitor.field("jump_gate", self.jump_gate, Range{1.0, 1e6}, "Mahalanobis^2",
                  "a larger innovation is a jump, which is followed and not smoothed; source: tracker study 2.7");
    visitor.field("coast_fade", self.coast_fade, Range{0.0, 1.0}, "per frame",
                  "what remains of the velocity after a frame without a measurement; source: a saccade lasts 3 frames");
  }
};

/// The paper's smoothing: a Kalman filter with constant velocity over (x, y, theta); the magnification walks beside it.
/// Frame px, rad, time in frames. A jump is followed at once, without lag.
///
///   PosePrediction predicted = filter.predict(1.0);
///   PoseEstimate smoothed = filter.correct(measured);   // or filter.coast() when the frame is refused
class PoseFilter {
 public:
  explicit PoseFilter(const PoseFilterOptions& options = {});

  /// Starts at rest in a known pose.
  void reset(const PoseEstimate& start);
  /// Moves the state `frames` frame periods on (1 in a regular video; values that are not finite or negative count as
  /// 0).
  PosePrediction predict(double frames);
  /// Takes a measurement of the predicted frame: pose with its 3x3 covariance, which is made symmetric and positive.
  /// A measurement that is not finite, or has a scale that is not positive, is refused: the state coasts.
  /// @return the filtered pose and covariance
  PoseEstimate correct(const PoseEstimate& measured);
  /// The predicted frame brought no measurement: the velocity fades, the uncertainty stays as predicted and grows on.
  void coast();

  PoseEstimate estimate() const;
  /// (x, y, theta) per frame; px, rad.
  Eigen::Vector3d velocity() const { return state_.tail<3>(); }
  /// Whether the last correction was a jump.
  bool jumped() const { return jumped_; }

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  void correctScale(double measured);
  void jumpTo(const retina::Pose2& pose, const Eigen::Matrix3d& covariance);
  void limitCovariance();

  PoseFilterOptions options_;
  Vector6 state_ = Vector6::Zero();  // x, y, theta, and their velocities
  Matrix6 covariance_ = Matrix6::Identity();
  double scale_ = 1.0;
  double scale_variance_ = 0.0;
  bool jumped_ = false;
};

}  // namespace eyeslam::tracking
