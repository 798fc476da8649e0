// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/calibration.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "eyeslam/retina/smoothstep.h"
#include "eyeslam/retina/units.h"

namespace eyeslam::servo {

using retina::Reason;

namespace {

// Hz; the rosette fills the disc: its petals turn by 144 deg from one pass of the middle to the next.
constexpr double kAcross = 0.5;
constexpr double kAround = 0.2;
constexpr double kAlong = 0.375;  // no multiple of the others, so that depth is not tied to a place

std::vector<Eigen::Vector3d> surfacePoints(const CalibrationSamples& samples, const Registration& registration,
                                           double farthest)
{
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!samples[i].spot_seen) continue;
    if (const auto point = placeOnBeam(registration, samples[i], farthest)) points.push_back(*point);
  }
  return points;
}

// Where the instrument is: decides which side of the surface is above.
Eigen::Vector3d meanTip(const CalibrationSamples& samples)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < samples.size(); ++i) sum += samples[i].tip.tip;
  return sum / static_cast<double>(std::max<std::size_t>(samples.size(), 1));
}

}  // namespace

CalibrationPattern::CalibrationPattern(const CalibrationPatternOptions& options)
    : lateral_(kMilli * options.lateral_mm),
      backwards_(kMilli * options.backwards_mm),
      duration_(options.duration_s),
      ramp_(options.ramp_s)
{}

void CalibrationPattern::start(const Eigen::Vector3d& shaft) noexcept
{
  right_.setZero();
  if (shaft.allFinite() && shaft.norm() > 0.5) right_ = shaft.unitOrthogonal();
}

Eigen::Vector3d CalibrationPattern::at(double time_s, const Eigen::Vector3d& shaft) const noexcept
{
  const bool running = time_s > 0.0 && time_s < duration_;  // false for NaN
  if (!running || !shaft.allFinite() || !(shaft.norm() > 0.5)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d axis = shaft.normalized();
  // What is left of the first direction: unlike a fresh one it cannot flip from one cycle to the next.
  const Eigen::Vector3d across = right_ - axis.dot(right_) * axis;
  if (!(across.norm() > 0.5)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d right = across.normalized();
  const double share = retina::smoothstep(std::min({1.0, time_s / ramp_, (duration_ - time_s) / ramp_}));
  const double radius = share * lateral_ * std::sin(kTwoPi * kAcross * time_s);
  const double angle = kTwoPi * kAround * time_s;
  const double back = share * backwards_ * 0.5 * (1.0 - std::cos(kTwoPi * kAlong * time_s));
  return radius * (std::cos(angle) * right + std::sin(angle) * axis.cross(right)) - back * axis;
}

std::optional<Eigen::Vector3d> placeOnBeam(const Registration& registration, const CalibrationSample& sample,
                                           double farthest)
{
  const Eigen::Vector2d px_per_m = registration.image_T_base.leftCols<3>() * sample.shaft;
  const Eigen::Vector2d way_px = sample.spot_px - registration.toImage(sample.tip.tip);
  const double along = px_per_m.dot(way_px) / px_per_m.squaredNorm();
  if (!(along >= 0.0 && along <= farthest)) return std::nullopt;
  return sample.tip.tip + along * sample.shaft;
}

CalibrationResult evaluate(const CalibrationSamples& samples, const CalibrationOptions& options)
{
  CalibrationResult result;
  result.camera = CameraRegistration(options.camera);
  if (static_cast<double>(samples.size()) < options.least_frames) return result;
  std::vector<TipSample> tips;
  for (std::size_t i = 0; i < samples.size(); ++i) tips.push_back(samples[i].tip);
  result.reason = result.camera.fit(tips);
  if (result.reason != Reason::none) return result;
  const std::vector<Eigen::Vector3d> points =
      surfacePoints(samples, result.camera.result(), kMilli * options.farthest_spot_mm);
  const SurfaceFit surface = fitSurface(points, meanTip(samples), options.surface);
  result.plane_reason = surface.reason;
  if (surface.reason != Reason::none) return result;
  result.plane = surface.plane;
  result.surface_points = static_cast<std::size_t>(surface.used);
  return result;
}

}  // namespace eyeslam::servo
