// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/robot/tip_motion.h"

#include <algorithm>

namespace eyeslam::robot {

Eigen::Vector3d Workspace::shortened(const Eigen::Vector3d& way, const Eigen::Vector3d& axis) const
{
  const double along = way.dot(axis);
  const Eigen::Vector3d across = way - along * axis;
  const double share = std::min(1.0, reach_lateral / std::max(across.norm(), 1e-12));
  return share * across + std::clamp(along, -reach_axial, reach_axial) * axis;
}

void TipMotion::startAt(const Eigen::Vector3d& tip)
{
  kind_ = Kind::rest;
  goal_ = tip;
  velocity_.setZero();
  saturated_ = false;
}

void TipMotion::setVelocity(const Eigen::Vector3d& velocity)
{
  kind_ = velocity.isZero(0.0) ? Kind::rest : Kind::velocity;
  velocity_ = velocity;
}

void TipMotion::setPosition(const Eigen::Vector3d& tip)
{
  kind_ = Kind::position;
  target_ = tip;
  velocity_.setZero();
}

void TipMotion::setDeflection(const Eigen::Vector3d& way)
{
  kind_ = Kind::deflection;
  target_ = way;
  velocity_.setZero();
}

const Eigen::Vector3d& TipMotion::step(double time_s, const Eigen::Vector3d& null, const Eigen::Vector3d& axis,
                                       const Workspace& workspace)
{
  if (kind_ == Kind::velocity) goal_ += time_s * velocity_;
  if (kind_ == Kind::position) goal_ = target_;
  if (kind_ == Kind::deflection) goal_ = null + target_;
  const Eigen::Vector3d asked = goal_ - null;
  const Eigen::Vector3d way = workspace.shortened(asked, axis);
  constexpr double kRounding = 1e-9;
  // A step of no time asks for nothing new.
  const bool asks = time_s > 0.0 || kind_ == Kind::position || kind_ == Kind::deflection;
  if (asks) saturated_ = (asked - way).norm() > kRounding;
  goal_ = null + way;
  return goal_;
}

}  // namespace eyeslam::robot
