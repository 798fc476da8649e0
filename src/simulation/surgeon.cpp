// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/surgeon.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

// The part of a way that exceeds a length.
Eigen::Vector3d beyond(const Eigen::Vector3d& way, double length)
{
  const double distance = way.norm();
  return distance > length ? Eigen::Vector3d(way * (1.0 - length / distance)) : Eigen::Vector3d::Zero();
}

}  // namespace

Surgeon::Surgeon(const SurgeonOptions& options, const Eigen::Vector3d& start, double period_s)
    : gain_(options.gain_hz),
      dead_zone_(options.dead_zone_um * kMicro),
      patience_(options.patience_um * kMicro),
      period_s_(period_s),
      followed_(options.lag_ms > 0.0 ? 1.0 - std::exp(-period_s / (options.lag_ms * kMilli)) : 1.0),
      seen_(static_cast<std::size_t>(std::lround(options.reaction_ms * kMilli / period_s)) + 1),
      position_(start)
{}

Eigen::Vector3d Surgeon::wantedVelocity(const SurgeonView& seen) const
{
  return gain_ * (beyond(seen.target - seen.tip, dead_zone_) + beyond(seen.tip - seen.null, patience_)) +
         seen.path_velocity;
}

const Eigen::Vector3d& Surgeon::step(const SurgeonView& view)
{
  // Before the first reaction time has passed he goes by the first thing that he saw.
  if (!opened_) std::fill(seen_.begin(), seen_.end(), view);
  opened_ = true;
  seen_[oldest_] = view;
  oldest_ = (oldest_ + 1) % seen_.size();
  // He knows the path ahead, so its velocity is not late.
  SurgeonView seen = seen_[oldest_];
  seen.path_velocity = view.path_velocity;
  velocity_ += followed_ * (wantedVelocity(seen) - velocity_);
  position_ += velocity_ * period_s_;
  return position_;
}

}  // namespace eyeslam::simulation
