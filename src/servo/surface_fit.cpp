// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/surface_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "eyeslam/servo/robust_weights.h"

namespace eyeslam::servo {

using retina::Reason;

namespace {

constexpr int kDraws = 60;  // a third of wrong points leaves (2/3)^3 good draws: none in 60 has a chance of 1e-9
constexpr int kPlanePasses = 10;

struct Spread {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double narrow = 0.0;  // m, standard deviation across the narrower direction in the plane
};

std::vector<Eigen::Vector3d> choose(const std::vector<Eigen::Vector3d>& points, std::size_t most)
{
  std::vector<Eigen::Vector3d> finite;
  std::copy_if(points.begin(), points.end(), std::back_inserter(finite), [](const auto& p) { return p.allFinite(); });
  if (finite.size() <= most) return finite;
  std::vector<Eigen::Vector3d> chosen;
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(finite[i * finite.size() / most]);
  return chosen;
}

Spread weighted(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights)
{
  Spread spread;
  double total = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    spread.mean += weights[i] * points[i];
    total += weights[i];
  }
  spread.mean /= std::max(total, 1e-300);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d d = points[i] - spread.mean;
    scatter += weights[i] / std::max(total, 1e-300) * d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  spread.normal = axes.eigenvectors().col(0);
  spread.narrow = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
  return spread;
}

double medianDistance(const std::vector<Eigen::Vector3d>& points, const Spread& plane, std::vector<double>& scratch)
{
  scratch.clear();
  for (const auto& point : points) scratch.push_back(std::abs(plane.normal.dot(point - plane.mean)));
  return medianOf(scratch);
}

// Least median of squares over drawn triples; the draws are seeded, so that the same points give the same plane.
Spread drawnPlane(const std::vector<Eigen::Vector3d>& points)
{
  std::mt19937 random(1);
  std::vector<double> scratch;
  Spread best;
  double least = std::numeric_limits<double>::infinity();
  for (int draw = 0; draw < kDraws; ++draw) {
    const Eigen::Vector3d& a = points[random() % points.size()];
    const Eigen::Vector3d& b = points[random() % points.size()];
    const Eigen::Vector3d& c = points[random() % points.size()];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (!(normal.norm() > 0.0)) continue;
    const Spread candidate{a, normal.normalized(), 0.0};
    const double median = medianDistance(points, candidate, scratch);
    if (median >= least) continue;
    least = median;
    best = candidate;
  }
  return best;
}

}  // namespace

SurfaceFit fitSurface(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& towards,
                      const SurfaceFitOptions& options)
{
  SurfaceFit fit;
  const std::vector<Eigen::Vector3d> used = choose(points, static_cast<std::size_t>(options.most_points));
  if (static_cast<double>(used.size()) < options.least_points || !towards.allFinite()) return fit;
  Spread plane = drawnPlane(used);
  std::vector<double> weights(used.size()), scratch;
  for (int pass = 0; pass < kPlanePasses; ++pass) {
    constexpr double kNormal = 1.4826;
    constexpr double kSmallest = 1e-6;  // m; exact points would leave no width to the weights
    const double cut = 4.7 * std::max(kSmallest, kNormal * medianDistance(used, plane, scratch));
    for (std::size_t i = 0; i < used.size(); ++i) {
      weights[i] = biweight(plane.normal.dot(used[i] - plane.mean) / cut);
    }
    plane = weighted(used, weights);
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    const double distance = plane.normal.dot(used[i] - plane.mean);
    squares += distance * distance;
    ++fit.used;
  }
  if (plane.normal.dot(towards - plane.mean) < 0.0) plane.normal = -plane.normal;
  fit.plane = {plane.normal, plane.normal.dot(plane.mean), std::sqrt(squares / std::max(1, fit.used - 3))};
  const bool good = fit.used >= options.least_points && fit.plane.residual * 1e6 <= options.worst_residual_um &&
                    plane.narrow * 1e6 >= options.least_extent_um;
  fit.reason = good ? Reason::none : Reason::surface_unknown;
  return fit;
}

}  // namespace eyeslam::servo
