// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/motion_limiter.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"

namespace eyeslam::servo {

namespace {

// Written so that NaN becomes 0.
double usableStep(double time_s) { return time_s > 0.0 ? std::min(time_s, MotionLimiter::kLongestStep_s) : 0.0; }

// Scaled down first, so that squares of huge numbers do not overflow.
Eigen::Vector3d shortened(const Eigen::Vector3d& way, double longest)
{
  const double largest = way.cwiseAbs().maxCoeff();
  if (largest <= 0.0) return way;
  const Eigen::Vector3d unit = way / largest;
  const double length = unit.norm();
  return largest * length <= longest ? way : Eigen::Vector3d(unit * (longest / length));
}

double lengthOf(const Eigen::Vector3d& way)
{
  const double largest = way.cwiseAbs().maxCoeff();
  return largest > 0.0 ? largest * (way / largest).norm() : 0.0;
}

}  // namespace

MotionLimiter::MotionLimiter(const MotionLimiterOptions& options) noexcept
    : speed_(options.speed_mm_s * kMilli),
      acceleration_(options.acceleration_m_s2),
      braking_(options.braking_m_s2),
      arrival_(options.arrival_mm_s * kMilli),
      actuator_(options.actuator_mm_s * kMilli),
      reach_(options.reach_mm * kMilli)
{}

void MotionLimiter::standAt(const Eigen::Vector3d& goal, const Eigen::Vector3d& deflection) noexcept
{
  if (!goal.allFinite() || !deflection.allFinite()) return;
  goal_ = goal;
  deflection_ = shortened(deflection, reach_);
  velocity_.setZero();
}

const Eigen::Vector3d& MotionLimiter::goal(const Eigen::Vector3d& wanted, double time_s) noexcept
{
  const double step = usableStep(time_s);
  if (step == 0.0) return goal_;
  Eigen::Vector3d fitting = Eigen::Vector3d::Zero();  // velocity that is wanted
  if (wanted.allFinite()) {
    const Eigen::Vector3d way = wanted - goal_;
    const double distance = lengthOf(way);
    const double speed = std::min({speed_, std::sqrt(2.0 * braking_ * distance) + arrival_, distance / step});
    fitting = shortened(way, speed * step) / step;
  }
  // Both velocities lie within the limit, so all between them do.
  velocity_ += shortened(fitting - velocity_, acceleration_ * step);
  goal_ += velocity_ * step;
  return goal_;
}

const Eigen::Vector3d& MotionLimiter::deflection(const Eigen::Vector3d& wanted, double time_s) noexcept
{
  if (!wanted.allFinite()) return deflection_;
  const Eigen::Vector3d reachable = shortened(wanted, reach_);
  saturated_ = lengthOf(wanted) > reach_;
  deflection_ += shortened(reachable - deflection_, actuator_ * usableStep(time_s));
  return deflection_;
}

Eigen::Vector3d MotionLimiter::withinReach(const Eigen::Vector3d& deflection) const noexcept
{
  return shortened(deflection, reach_);
}

}  // namespace eyeslam::servo
