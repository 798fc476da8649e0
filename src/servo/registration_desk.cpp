// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/registration_desk.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/servo/unknown.h"

namespace eyeslam::servo {

using retina::Reason;

namespace {

// RMS per axis, px.
double sigmaOf(const messaging::ImagePoint& point) { return std::sqrt(std::max(0.0, 0.5 * point.covariance.trace())); }

// The new camera is expected to have the declared scale; where none is declared, any will do.
CameraRegistration expecting(CameraRegistration camera, double um_per_px, const std::optional<RetinaPlane>& plane)
{
  if (um_per_px > 0.0 && plane) camera.expectScale(um_per_px, *plane);
  return camera;
}

}  // namespace

RegistrationDesk::RegistrationDesk(const RegistrationDeskOptions& options) : options_(options), camera_(options.camera)
{}

void RegistrationDesk::observe(std::int64_t utime, const Eigen::Vector3d& tip, const Eigen::Vector3d& shaft) noexcept
{
  if (!tip.allFinite() || !shaft.allFinite()) return;
  if (!measured_.empty() && utime <= measured_.utime(0)) return;
  TipAndShaft value;
  value << tip, shaft;
  measured_.push(utime, value);
}

Reason RegistrationDesk::see(const messaging::InstrumentSight& sight) noexcept
{
  if (!sight.tip.present) return Reason::no_tip;
  if (!sight.tip.position_px.allFinite() || !std::isfinite(sight.frame.exposure)) return Reason::not_finite;
  if (sight.frame.utime <= seen_utime_) return Reason::tip_late;
  const std::optional<CalibrationSample> sample = sampleOf(sight);
  if (!sample) return Reason::tip_late;
  seen_utime_ = sight.frame.utime;
  if (calibrating_) samples_.add(*sample);
  // Before a calibration there is nothing to refine: a hand that hardly moves would make a registration of chance.
  if (!options_.refines || adoptions_ == 0) return Reason::none;
  const Reason why = camera_.add(sample->tip);
  if (why == Reason::none) utime_ = sight.frame.utime;
  return why;
}

std::optional<CalibrationSample> RegistrationDesk::sampleOf(const messaging::InstrumentSight& sight) const noexcept
{
  const std::int64_t half = microseconds(0.5 * std::max(0.0, sight.frame.exposure));
  const std::int64_t from = sight.frame.utime - half, to = sight.frame.utime + half;
  if (!measured_.covers(from) || !measured_.covers(to)) return std::nullopt;
  TipAndShaft sum = TipAndShaft::Zero();
  double count = 0.0;
  for (std::size_t age = measured_.firstAtOrBefore(to); age < measured_.size() && measured_.utime(age) >= from; ++age) {
    sum += measured_.value(age);
    count += 1.0;
  }
  const TipAndShaft mean = count > 0.0 ? TipAndShaft(sum / count) : measured_.at(sight.frame.utime);
  CalibrationSample sample;
  sample.tip.tip = mean.head<3>();
  sample.tip.image_px = sight.tip.position_px;
  sample.tip.sigma_px = std::hypot(std::max(options_.seen_px, sigmaOf(sight.tip)), measuredSigmaPx());
  sample.shaft = mean.tail<3>().normalized();
  sample.spot_seen = sight.spot.present && sight.spot.position_px.allFinite();
  sample.spot_px = sight.spot.position_px;
  return sample;
}

double RegistrationDesk::measuredSigmaPx() const noexcept
{
  const double um_per_px = umPerPx() > 0.0 ? umPerPx() : options_.declared_um_per_px;
  return um_per_px > 0.0 ? options_.measured_um / um_per_px : 0.0;
}

void RegistrationDesk::beginCalibration() noexcept
{
  samples_.clear();
  calibrating_ = true;
}

void RegistrationDesk::adopt(const CalibrationResult& result, std::int64_t utime) noexcept
{
  adopt(result.camera, result.plane, utime);
}

void RegistrationDesk::adopt(const CameraRegistration& camera, const std::optional<RetinaPlane>& plane,
                             std::int64_t utime) noexcept
{
  if (plane) plane_ = plane;
  camera_ = expecting(camera, options_.declared_um_per_px, plane_);
  utime_ = utime;
  ++adoptions_;
}

Reason RegistrationDesk::reason() const noexcept
{
  if (!camera_.result().good()) return camera_.result().reason;
  if (!plane_) return Reason::surface_unknown;
  return umPerPx() > 0.0 ? Reason::none : Reason::registration_uncertain;
}

double RegistrationDesk::umPerPx() const noexcept
{
  if (!plane_ || camera_.result().samples == 0) return 0.0;
  return camera_.result().umPerPx(*plane_).value_or(0.0);
}

double RegistrationDesk::sigma() const noexcept
{
  if (measured_.empty() || !(umPerPx() > 0.0)) return kUnknown;
  return 1e-6 * umPerPx() * camera_.result().sigmaOf(measured_.value(0).head<3>());
}

std::optional<ViewPlacement> RegistrationDesk::placement(const ViewScale& scale) const noexcept
{
  if (!good()) return std::nullopt;
  return placeView(camera_.result(), *plane_, scale);
}

messaging::PublishedRegistration RegistrationDesk::published() const noexcept
{
  const Registration& camera = camera_.result();
  messaging::PublishedRegistration published;
  published.reason = reason();
  published.valid = good();
  published.samples = camera.samples;
  published.image_T_manipulator = camera.image_T_base;
  published.row_covariance = camera.row_covariance;
  published.residual_px = camera.residual_px;
  published.condition = camera.condition;
  published.um_per_px = umPerPx();
  if (plane_) published.plane = {true, plane_->normal, plane_->distance, plane_->residual};
  return published;
}

CameraRegistration resumed(const messaging::PublishedRegistration& published, const CameraRegistrationOptions& options)
{
  Registration known;
  known.image_T_base = published.image_T_manipulator;
  known.row_covariance = published.row_covariance;
  known.residual_px = published.residual_px;
  known.condition = published.condition;
  known.samples = static_cast<int>(std::clamp<std::int64_t>(published.samples, 0, 1'000'000));
  CameraRegistration camera(options);
  camera.resume(known);
  return camera;
}

std::optional<RetinaPlane> planeOf(const messaging::PublishedRegistration& published)
{
  if (!published.plane.known) return std::nullopt;
  return RetinaPlane{published.plane.normal, published.plane.offset, published.plane.residual};
}

CalibrationResult calibrationOf(const messaging::PublishedRegistration& published,
                                const CameraRegistrationOptions& options)
{
  CalibrationResult result;
  result.camera = resumed(published, options);
  result.plane = planeOf(published);
  result.reason = result.camera.result().reason;
  return result;
}

}  // namespace eyeslam::servo
