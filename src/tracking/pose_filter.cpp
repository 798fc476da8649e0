// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/pose_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"

namespace eyeslam::tracking {

namespace {

using retina::Pose2;
using retina::wrapAngle;

constexpr double kStartSpeed = 3.0;  // sigma of an unknown velocity, in accelerations times a frame

// Sigmas between which everything stays: below, rounding would make a covariance indefinite; above, nothing is known
// anyway, and a view lost for hours must not overflow.
constexpr double kLeast_px = 1e-4, kLeast_rad = 1e-6;
constexpr double kMost_px = 2000.0, kMost_rad = kPi;
constexpr double kMostSpeed_px = 500.0, kMostSpeed_rad = 0.5;

bool isFinite(const PoseEstimate& estimate)
{
  const Pose2& pose = estimate.map_T_frame;
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta) && std::isfinite(pose.scale) &&
         pose.scale > 0.0 && estimate.covariance.allFinite();
}

/// The nearest covariance that the filter can work with: symmetric, eigenvalues between the limits.
Eigen::Matrix3d madeUsable(const Eigen::Matrix3d& covariance)
{
  // In units of the least sigmas, or the limits of an angle would rule those of a length.
  const Eigen::Vector3d unit(kLeast_px, kLeast_px, kLeast_rad);
  const Eigen::Matrix3d halves = 0.5 * covariance + 0.5 * covariance.transpose();
  const Eigen::Matrix3d scaled = unit.cwiseInverse().asDiagonal() * halves * unit.cwiseInverse().asDiagonal();
  const double most = kMost_rad * kMost_rad / (kLeast_rad * kLeast_rad);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scaled.cwiseMax(-most).cwiseMin(most));
  const Eigen::Vector3d values = eigen.eigenvalues().cwiseMax(1.0).cwiseMin(most);
  const Eigen::Matrix3d bounded = eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
  const Eigen::Matrix3d usable = unit.asDiagonal() * bounded * unit.asDiagonal();
  return 0.5 * (usable + usable.transpose());
}

}  // namespace

PoseFilter::PoseFilter(const PoseFilterOptions& options) : options_(options) { reset({}); }

void PoseFilter::reset(const PoseEstimate& start)
{
  const PoseEstimate usable = isFinite(start) ? start : PoseEstimate{};
  jumpTo(usable.map_T_frame, madeUsable(usable.covariance));
  scale_variance_ = 0.0;
  jumped_ = false;
}

void PoseFilter::jumpTo(const Pose2& pose, const Eigen::Matrix3d& covariance)
{
  const double speed_px = kStartSpeed * options_.acceleration_px;
  const double speed_rad = kStartSpeed * options_.acceleration_deg * kDegree;
  state_ << pose.x, pose.y, wrapAngle(pose.theta), 0.0, 0.0, 0.0;
  covariance_.setZero();
  covariance_.topLeftCorner<3, 3>() = covariance;
  covariance_.diagonal().tail<3>() << speed_px * speed_px, speed_px * speed_px, speed_rad * speed_rad;
  scale_ = pose.scale;
  jumped_ = true;
}

PosePrediction PoseFilter::predict(double frames)
{
  const double dt = std::isfinite(frames) ? std::clamp(frames, 0.0, 1e4) : 0.0;
  Matrix6 transition = Matrix6::Identity();
  transition.topRightCorner<3, 3>().diagonal().setConstant(dt);
  state_ = transition * state_;
  state_(2) = wrapAngle(state_(2));
  // White acceleration, constant during the step: it moves the pose by dt^2 / 2 and the velocity by dt.
  const Eigen::Vector3d acceleration(options_.acceleration_px, options_.acceleration_px,
                                     options_.acceleration_deg * kDegree);
  Eigen::Matrix<double, 6, 3> effect;
  effect << Eigen::Matrix3d(acceleration.asDiagonal()) * (dt * dt / 2.0),
      Eigen::Matrix3d(acceleration.asDiagonal()) * dt;
  covariance_ = transition * covariance_ * transition.transpose() + effect * effect.transpose();
  limitCovariance();
  scale_variance_ = std::min(1.0, scale_variance_ + options_.scale_walk * options_.scale_walk * dt);
  const PoseEstimate predicted = estimate();
  return {predicted.map_T_frame, predicted.covariance};
}

PoseEstimate PoseFilter::correct(const PoseEstimate& measured)
{
  jumped_ = false;
  if (!isFinite(measured)) {
    coast();
    return estimate();
  }
  const Eigen::Matrix3d noise = madeUsable(measured.covariance);
  const Pose2& pose = measured.map_T_frame;
  const Eigen::Vector3d innovation(pose.x - state_(0), pose.y - state_(1), wrapAngle(pose.theta - state_(2)));
  const Eigen::LLT<Eigen::Matrix3d> spread(Eigen::Matrix3d(covariance_.topLeftCorner<3, 3>() + noise));
  if (!(innovation.dot(spread.solve(innovation)) <= options_.jump_gate)) {
    jumpTo(pose, noise);
    return estimate();
  }
  const Eigen::Matrix<double, 6, 3> gain = spread.solve(covariance_.topRows<3>()).transpose();
  state_ += gain * innovation;
  state_(2) = wrapAngle(state_(2));
  // Joseph's form stays positive under rounding, where (I - K H) P does not.
  Matrix6 remains = Matrix6::Identity();
  remains.leftCols<3>() -= gain;
  covariance_ = remains * covariance_ * remains.transpose() + gain * noise * gain.transpose();
  limitCovariance();
  correctScale(pose.scale);
  return estimate();
}

void PoseFilter::correctScale(double measured)
{
  const double noise = options_.scale_noise * options_.scale_noise;
  const double gain = scale_variance_ / (scale_variance_ + noise);
  scale_ += gain * (measured - scale_);
  scale_variance_ *= 1.0 - gain;
}

void PoseFilter::coast()
{
  state_.tail<3>() *= options_.coast_fade;
  jumped_ = false;
}

PoseEstimate PoseFilter::estimate() const
{
  return {{state_(0), state_(1), state_(2), scale_}, covariance_.topLeftCorner<3, 3>()};
}

void PoseFilter::limitCovariance()
{
  Vector6 most, least;
  most << kMost_px, kMost_px, kMost_rad, kMostSpeed_px, kMostSpeed_px, kMostSpeed_rad;
  least << kLeast_px, kLeast_px, kLeast_rad, kLeast_px, kLeast_px, kLeast_rad;
  // Scaling rows and columns alike keeps a covariance positive; cutting its entries would not.
  const Vector6 sigma = covariance_.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Vector6 shrink = (most.array() / sigma.array().max(least.array())).min(1.0);
  const Matrix6 limited = shrink.asDiagonal() * covariance_ * shrink.asDiagonal();
  covariance_ = 0.5 * (limited + limited.transpose());
  covariance_.diagonal() += 0.01 * least.cwiseAbs2();
}

}  // namespace eyeslam::tracking
