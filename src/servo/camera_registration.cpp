// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/camera_registration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "eyeslam/retina/units.h"
#include "eyeslam/servo/robust_weights.h"

namespace eyeslam::servo {

using retina::Reason;

namespace {

constexpr double kDriftShare = 0.05;    // of the newest innovation in the mean: some twenty samples
constexpr double kClearSight_px = 5.0;  // sigma of a tip that is found along its shaft; trials: 1 px, else 15
constexpr double kMostDrift = 2.0;      // times the limit, that a single sample counts for
constexpr int kPasses = 12;             // of reweighting in fit()
constexpr double kSmallestInformation = 1e-9;

bool isFinite(const TipSample& sample)
{
  return sample.tip.allFinite() && sample.image_px.allFinite() && std::isfinite(sample.sigma_px) &&
         sample.sigma_px > 0.0;
}

// The smaller singular value: of two rows their squares sum to the rows' and their product is the area between them.
double leastScale(const Eigen::Matrix<double, 2, 3>& rows)
{
  const double squares = rows.squaredNorm();
  const double twice_area = 2.0 * rows.row(0).cross(rows.row(1)).norm();
  return 0.5 * (std::sqrt(squares + twice_area) - std::sqrt(std::max(0.0, squares - twice_area)));
}

}  // namespace

double Registration::sigmaOf(const Eigen::Vector3d& tip) const
{
  const Eigen::Vector4d row = tip.homogeneous();
  return std::sqrt(std::max(0.0, row.dot(row_covariance * row)));
}

std::optional<Eigen::Vector3d> Registration::toPlane(const Eigen::Vector2d& image_px, const RetinaPlane& plane) const
{
  Eigen::Matrix3d system;
  system << image_T_base.leftCols<3>(), plane.normal.transpose();
  const Eigen::Vector3d right(image_px.x() - image_T_base(0, 3), image_px.y() - image_T_base(1, 3), plane.distance);
  const Eigen::FullPivLU<Eigen::Matrix3d> solver(system);
  const Eigen::Vector3d point = solver.solve(right);
  if (!solver.isInvertible() || !point.allFinite()) return std::nullopt;
  return point;
}

std::optional<double> Registration::umPerPx(const RetinaPlane& plane) const
{
  // Px per metre along two orthogonal directions of the plane: the area's root is the mean scale.
  const Eigen::Vector3d first = plane.normal.unitOrthogonal();
  const Eigen::Vector3d second = plane.normal.cross(first);
  Eigen::Matrix2d px_per_m;
  px_per_m << image_T_base.leftCols<3>() * first, image_T_base.leftCols<3>() * second;
  const double scale = std::sqrt(std::abs(px_per_m.determinant()));
  if (!(scale > 0.0) || !std::isfinite(scale)) return std::nullopt;
  return 1e6 / scale;
}

CameraRegistration::CameraRegistration(const CameraRegistrationOptions& options) : options_(options) {}

CameraRegistration::Row CameraRegistration::regressor(const Eigen::Vector3d& tip) const
{
  return ((tip - origin_) * kPerMilli).homogeneous();
}

void CameraRegistration::forget()
{
  information_.setZero();
  moments_.setZero();
  drift_um_.setZero();
  squares_ = weights_ = 0.0;
  result_ = {};
}

Reason CameraRegistration::fit(const std::vector<TipSample>& samples)
{
  forget();
  std::vector<TipSample> used;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(used), isFinite);
  refused_ += static_cast<int>(samples.size() - used.size());
  if (static_cast<double>(used.size()) < options_.least_samples) return result_.reason = Reason::not_registered;
  origin_ = used.front().tip;
  std::vector<double> weights(used.size(), 1.0), distances(used.size());
  double noise = 1.0;  // as a multiple of the stated sigmas
  for (int pass = 0; pass < kPasses; ++pass) {
    forget();
    for (std::size_t i = 0; i < used.size(); ++i) absorb(used[i], weights[i]);
    solve();
    const auto sigmas = [&](const TipSample& sample) {
      return (sample.image_px - result_.toImage(sample.tip)).norm() / sample.sigma_px;
    };
    std::transform(used.begin(), used.end(), distances.begin(), sigmas);
    constexpr double kMedianOfTwo = 1.1774;  // of the length of a vector of two unit normals
    std::vector<double> sorted = distances;
    noise = std::max(0.1, medianOf(sorted) / kMedianOfTwo);
    for (std::size_t i = 0; i < used.size(); ++i)
      weights[i] = biweight(distances[i] / noise / (1.5 * options_.outlier_sigmas));
  }
  last_tip_ = used.back().tip;
  refused_ += static_cast<int>(std::count(weights.begin(), weights.end(), 0.0));
  return result_.reason = verdict();
}

// It shows in samples that are refused as well: they all lie on the same side. A single wrong one counts little.
void CameraRegistration::noteDrift(const Eigen::Vector2d& innovation_px)
{
  const double px_per_um = 1e-6 * result_.image_T_base.leftCols<3>().norm() / std::sqrt(2.0);
  if (!(px_per_um > 0.0)) return;
  const Eigen::Vector2d um = innovation_px / px_per_um;
  const double length = std::max(1.0, um.norm() / (kMostDrift * options_.drift_um));
  drift_um_ += kDriftShare * (um / length - drift_um_);
}

Reason CameraRegistration::add(const TipSample& sample)
{
  const auto refuse = [&](Reason why) {
    ++refused_;
    return why;
  };
  if (!isFinite(sample)) return refuse(Reason::not_finite);
  if (result_.samples == 0) origin_ = last_tip_ = sample.tip;
  const bool moved = (sample.tip - last_tip_).norm() * 1e6 >= options_.least_step_um;
  if (result_.samples > 0 && !moved) return refuse(Reason::tip_at_rest);
  if (static_cast<double>(result_.samples) >= options_.least_samples) {
    const double noise = std::max(1.0, result_.residual_px / sample.sigma_px);
    const double sigma = std::hypot(noise * sample.sigma_px, result_.sigmaOf(sample.tip));
    const Eigen::Vector2d innovation = sample.image_px - result_.toImage(sample.tip);
    // A sight that is itself uncertain, as of a tip over another dark thing, tells little of a drift.
    const double blur = sample.sigma_px / kClearSight_px;
    noteDrift(innovation / (1.0 + blur * blur));
    if (innovation.norm() > options_.outlier_sigmas * sigma) {
      result_.reason = verdict();
      return refuse(Reason::outlier);
    }
  }
  if (result_.good() && bringsNothing(sample.tip)) {
    result_.reason = verdict();
    return refuse(Reason::tip_at_rest);
  }
  information_ *= options_.forgetting;
  moments_ *= options_.forgetting;
  squares_ *= options_.forgetting;
  weights_ *= options_.forgetting;
  last_tip_ = sample.tip;
  absorb(sample, 1.0);
  solve();
  result_.reason = verdict();
  return Reason::none;
}

bool CameraRegistration::bringsNothing(const Eigen::Vector3d& tip) const
{
  const double from_mean = ((tip - origin_) * kPerMilli - mean_).norm();
  return spread_ < 1e-3 * options_.least_spread_um && from_mean < spread_;
}

Reason CameraRegistration::resume(const Registration& known)
{
  forget();
  const Eigen::Matrix4d covariance = known.row_covariance;
  const Eigen::LDLT<Eigen::Matrix3d> lateral(covariance.topLeftCorner<3, 3>());
  // Where the projection is surest: the middle of the tips it was estimated from.
  const Eigen::Vector3d middle = -lateral.solve(covariance.topRightCorner<3, 1>());
  if (!known.image_T_base.allFinite() || known.samples <= 0 || !(known.residual_px >= 0.0) || !middle.allFinite())
    return result_.reason = Reason::out_of_range;
  origin_ = last_tip_ = middle;
  const Eigen::Matrix4d own = toOwn();
  const Eigen::Matrix4d inverse = own.inverse();
  information_ = (inverse.transpose() * covariance * inverse).inverse();
  information_ = (0.5 * (information_ + information_.transpose())).eval();
  const Eigen::Matrix<double, 4, 2> rows = (known.image_T_base * inverse).transpose();
  moments_ = information_ * rows;
  weights_ = information_(3, 3);
  result_.samples = known.samples;
  const double freedoms = std::max(1.0, 2.0 * known.samples - 8.0);
  squares_ = rows.cwiseProduct(moments_).sum() +
             known.residual_px * known.residual_px * freedoms * weights_ / static_cast<double>(known.samples);
  if (!information_.allFinite() || !(weights_ > 0.0)) {
    forget();
    return result_.reason = Reason::out_of_range;
  }
  solve();
  return result_.reason = verdict();
}

void CameraRegistration::expectScale(double um_per_px, const RetinaPlane& plane)
{
  expected_um_per_px_ = um_per_px;
  expected_plane_ = plane;
  result_.reason = verdict();
}

// From metres about the manipulator's origin to mm about ours.
Eigen::Matrix4d CameraRegistration::toOwn() const
{
  Eigen::Matrix4d own = Eigen::Matrix4d::Identity();
  own.topLeftCorner<3, 3>() *= kPerMilli;
  own.topRightCorner<3, 1>() = -kPerMilli * origin_;
  return own;
}

void CameraRegistration::absorb(const TipSample& sample, double weight)
{
  const Row row = regressor(sample.tip);
  const double w = weight / (sample.sigma_px * sample.sigma_px);
  information_ += w * row * row.transpose();
  moments_ += w * row * sample.image_px.transpose();
  squares_ += w * sample.image_px.squaredNorm();
  weights_ += w;
  if (weight > 0.0) ++result_.samples;
}

void CameraRegistration::solve()
{
  Eigen::Matrix4d information = information_;
  // So little that no sample feels it, but a direction that nothing excites stays finite with a huge variance.
  information.diagonal().array() += kSmallestInformation * (1.0 + information.trace());
  const Eigen::LDLT<Eigen::Matrix4d> solver(information);
  const Eigen::Matrix<double, 4, 2> rows = solver.solve(moments_);
  const Eigen::Matrix4d inverse = solver.solve(Eigen::Matrix4d::Identity());
  const double squares = std::max(0.0, squares_ - rows.cwiseProduct(moments_).sum());
  const double freedoms = std::max(1.0, 2.0 * result_.samples - 8.0);
  const double of_samples = weights_ > 0.0 ? static_cast<double>(result_.samples) / weights_ : 0.0;  // mean sigma^2
  result_.residual_px = std::sqrt(squares / freedoms * of_samples);
  const double noise = std::max(1.0, squares / freedoms);
  // From mm about the origin back to metres about the manipulator's own.
  const Eigen::Matrix4d own = toOwn();
  result_.image_T_base = rows.transpose() * own;
  result_.row_covariance = noise * own.transpose() * inverse * own;

  const Eigen::Vector3d mean = information_.topRightCorner<3, 1>() / std::max(weights_, 1e-300);
  const Eigen::Matrix3d scatter =
      information_.topLeftCorner<3, 3>() / std::max(weights_, 1e-300) - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(scatter);
  // The two larger ones: depth may be nearly constant over a flat retina, and the affine camera hardly feels it.
  mean_ = mean;
  spread_ = std::sqrt(std::max(0.0, spread.eigenvalues()[1]));
  result_.condition = std::sqrt(spread.eigenvalues()[2] / std::max(spread.eigenvalues()[1], 1e-12));
}

Reason CameraRegistration::verdict() const
{
  if (result_.samples < options_.least_samples || !result_.image_T_base.allFinite()) return Reason::not_registered;
  const double px_per_m = leastScale(result_.image_T_base.leftCols<3>());
  if (!(px_per_m > 0.0)) return Reason::registration_uncertain;
  if (result_.residual_px > options_.worst_residual_px) return Reason::registration_residual;
  constexpr double k95 = 2.4477;  // of a planar normal error
  if (k95 * result_.sigmaOf(last_tip_) / px_per_m * 1e6 > options_.worst_error_um)
    return Reason::registration_uncertain;
  if (drift_um_.norm() > options_.drift_um) return Reason::registration_drift;
  if (expected_um_per_px_) {
    const std::optional<double> found = result_.umPerPx(expected_plane_);
    if (!found || std::abs(*found / *expected_um_per_px_ - 1.0) > options_.scale_tolerance)
      return Reason::registration_scale;
  }
  return Reason::none;
}

}  // namespace eyeslam::servo
