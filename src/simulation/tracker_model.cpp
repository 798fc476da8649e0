// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/tracker_model.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

constexpr std::uint64_t kTrackerStream = 80, kRegistrationStream = 81;  // of the seed

Eigen::Vector2d normals(Random& random)
{
  const double x = random.normal();
  return {x, random.normal()};
}

Eigen::Vector2d anywhere(Random& random)
{
  const double angle = random.uniform(0.0, kTwoPi);
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

void TrackerModel::Wander::step(Random& random)
{
  value = kept * value + rms * std::sqrt(1.0 - kept * kept) * normals(random);
}

TrackerModel::TrackerModel(const CameraTimingOptions& timing, const TrackerModelOptions& errors,
                           const RegistrationErrorOptions& registration, std::uint64_t seed,
                           const Eigen::Vector2d& centre, double period_s)
    : errors_(errors),
      centre_(centre),
      interval_(1.0 / timing.rate_hz),
      exposure_(timing.exposure_ms * kMilli),
      latency_low_(timing.latency_low_ms * kMilli),
      latency_high_(timing.latency_high_ms * kMilli),
      period_s_(period_s),
      random_(seed, kTrackerStream),
      bias_{std::exp(-interval_ / errors.bias_s), errors.bias_um * kMicro, Eigen::Vector2d::Zero()},
      picture_{std::exp(-interval_ / registration.drift_s), registration.drift_um * kMicro, Eigen::Vector2d::Zero()},
      mid_exposure_(0.5 * exposure_ + interval_ * random_.uniform())
{
  bias_.value = bias_.rms * normals(random_);
  picture_.value = picture_.rms * normals(random_);
}

void TrackerModel::expose(double t_s, const RetinaPose& world_T_retina, const Eigen::Vector3d& tip)
{
  // A shutter that is open for less than a period sees the instant nearest to the middle.
  const double half = 0.5 * std::max(exposure_, period_s_);
  if (t_s > mid_exposure_ + half && sum_.count > 0.0) finish();
  if (t_s <= mid_exposure_ - half) return;
  const Eigen::Vector3d centre(centre_.x(), centre_.y(), 0.0);
  const Eigen::Vector2d shift = (world_T_retina.toWorld(centre) - centre).head<2>();
  if (sum_.count == 0.0) sum_.first = shift;
  sum_.last = shift;
  sum_.pose += Eigen::Vector3d(shift.x(), shift.y(), world_T_retina.theta);
  sum_.tip += tip.head<2>();
  sum_.count += 1.0;
}

void TrackerModel::finish()
{
  const Eigen::Vector2d blur = sum_.last - sum_.first;
  const double speed = sum_.count > 1.0 ? blur.norm() / ((sum_.count - 1.0) * period_s_) : 0.0;
  bias_.step(random_);
  picture_.step(random_);
  TrackedFrame frame;
  frame.mid_exposure_s = mid_exposure_;
  frame.ready_s = mid_exposure_ + random_.uniform(latency_low_, latency_high_);
  frame.tracked = !(speed > errors_.fast_mm_s * kMilli && random_.chance(errors_.fast_refused));
  const Eigen::Vector3d mean = sum_.pose / sum_.count;
  Eigen::Vector2d shift = mean.head<2>() + bias_.value + errors_.noise_um * kMicro * normals(random_);
  shift += errors_.blur_share * random_.normal() * blur;
  if (random_.chance(errors_.outliers)) {
    frame.outlier = true;
    frame.tracked = frame.tracked && random_.chance(errors_.unflagged);
    shift += random_.uniform(errors_.outlier_low_um, errors_.outlier_high_um) * kMicro * anywhere(random_);
  }
  shift += picture_.value;
  const double theta = mean.z() + errors_.turn_noise_deg * kDegree * random_.normal();
  frame.view_T_retina = {shift.x(), shift.y(), theta, 1.0};
  frame.tip = sum_.tip / sum_.count + picture_.value + errors_.tip_noise_um * kMicro * normals(random_);
  if (count_ < kWaiting) waiting_[(first_ + count_++) % kWaiting] = frame;
  sum_ = {};
  mid_exposure_ += interval_;
}

std::optional<TrackedFrame> TrackerModel::ready(double t_s)
{
  if (count_ == 0 || waiting_[first_].ready_s > t_s) return std::nullopt;
  const TrackedFrame frame = waiting_[first_];
  first_ = (first_ + 1) % kWaiting;
  --count_;
  return frame;
}

Eigen::Matrix<double, 2, 3> wrongRegistration(const RegistrationErrorOptions& options, std::uint64_t seed,
                                              const Eigen::Vector2d& centre)
{
  Random random(seed, kRegistrationStream);
  const double scale = 1.0 + (random.chance(0.5) ? 1.0 : -1.0) * options.scale;
  const double angle = (random.chance(0.5) ? 1.0 : -1.0) * options.rotation_deg * kDegree;
  Eigen::Matrix<double, 2, 3> map;
  map << scale * std::cos(angle), -scale * std::sin(angle), 0.0, scale * std::sin(angle), scale * std::cos(angle), 0.0;
  map.col(2) = centre - map.leftCols<2>() * centre;
  return map;
}

}  // namespace eyeslam::simulation
