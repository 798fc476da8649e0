// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/pivot_estimator.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "eyeslam/retina/units.h"

namespace eyeslam::servo {

using retina::Reason;

namespace {

constexpr double k95 = 1.96;  // sigmas of an error along one direction
constexpr int kGone = 20;     // shafts in a row that pass it by: the pivot serves no longer
constexpr int kElsewhere = 500;
constexpr double kNoEstimate = std::numeric_limits<double>::infinity();

bool isPose(const messaging::ToolPose& pose)
{
  return pose.position.allFinite() && pose.orientation.coeffs().allFinite() &&
         std::abs(pose.orientation.norm() - 1.0) < 1e-3;
}

double distanceFromLine(const Eigen::Vector3d& point, const Eigen::Vector3d& on_line, const Eigen::Vector3d& axis)
{
  return (point - on_line).cross(axis).norm();
}

}  // namespace

PivotEstimator::PivotEstimator(const PivotEstimatorOptions& options) noexcept : options_(options), sigma_(kNoEstimate)
{}

bool PivotEstimator::isKnown() const noexcept
{
  return samples_ >= options_.least_samples && k95 * sigma_ <= options_.worst_error_um * kMicro;
}

std::optional<Eigen::Vector3d> PivotEstimator::pivot() const noexcept
{
  if (!isKnown() || refused_in_a_row_ >= kGone) return std::nullopt;
  return rest_ + displacement_;
}

bool PivotEstimator::isNew(const Eigen::Vector3d& axis) const noexcept
{
  return samples_ == 0 || axis.cross(last_axis_).norm() >= options_.least_turn_mrad * kMilli;
}

Reason PivotEstimator::observe(const messaging::ToolPose& null, const Eigen::Vector3d& port_displacement) noexcept
{
  if (!isPose(null) || !port_displacement.allFinite()) return Reason::not_finite;
  const Eigen::Vector3d axis = (null.orientation * Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d at_rest = null.position - port_displacement;
  displacement_ = port_displacement;
  if (isKnown() && distanceFromLine(rest_, at_rest, axis) > options_.outlier_um * kMicro) {
    if (++refused_in_a_row_ >= kElsewhere) startAnew();
    return Reason::outlier;
  }
  refused_in_a_row_ = 0;
  if (!isNew(axis)) return Reason::tip_at_rest;
  if (samples_ == 0) origin_ = at_rest;
  last_axis_ = axis;
  absorb((at_rest - origin_) * kPerMilli, axis);
  solve();
  return Reason::none;
}

// The squared distance of p from a line is (p - a)' (I - s s') (p - a).
void PivotEstimator::absorb(const Eigen::Vector3d& point, const Eigen::Vector3d& axis) noexcept
{
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
  const Eigen::Vector3d foot = across * point;
  information_ = options_.forgetting * information_ + across;
  moment_ = options_.forgetting * moment_ + foot;
  squares_ = options_.forgetting * squares_ + foot.squaredNorm();
  weight_ = options_.forgetting * weight_ + 1.0;
  ++samples_;
}

void PivotEstimator::solve() noexcept
{
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread;
  spread.compute(information_);
  const double least = spread.eigenvalues()[0];
  constexpr double kParallel = 1e-9;  // of the weight: shafts within 0.03 mrad
  if (!(least > kParallel * weight_)) {
    sigma_ = kNoEstimate;
    return;
  }
  const Eigen::Vector3d along = spread.eigenvectors().transpose() * moment_;
  const Eigen::Vector3d solution = spread.eigenvectors() * along.cwiseQuotient(spread.eigenvalues());
  const double freedoms = std::max(1.0, 2.0 * weight_ - 3.0);  // two distances a line
  const double variance = std::max(0.0, squares_ - solution.dot(moment_)) / freedoms;
  residual_ = std::sqrt(2.0 * variance) / kPerMilli;
  rest_ = origin_ + solution / kPerMilli;
  const double least_residual = options_.least_residual_um * kMicro;
  sigma_ = std::max(std::sqrt(variance) / kPerMilli, least_residual) * std::sqrt(options_.shafts_alike / least);
}

void PivotEstimator::startAnew() noexcept { *this = PivotEstimator(options_); }

}  // namespace eyeslam::servo
