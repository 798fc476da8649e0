// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/robot/tool_jacobian.h"

namespace eyeslam::robot {

namespace {

constexpr double kTooNear = 1e-3;  // m; there a motion of the tip would turn the tool wildly

}  // namespace

Eigen::Matrix3d crossProduct(const Eigen::Vector3d& v)
{
  Eigen::Matrix3d cross;
  cross << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return cross;
}

ToolJacobian toolJacobian(const Eigen::Vector3d& tip, const std::optional<Eigen::Vector3d>& pivot)
{
  ToolJacobian jacobian;
  jacobian << Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero();
  if (!pivot) return jacobian;
  const Eigen::Vector3d shaft = tip - *pivot;
  if (shaft.norm() > kTooNear) jacobian.bottomRows<3>() = crossProduct(shaft) / shaft.squaredNorm();
  return jacobian;
}

ToolJacobian inToolAxes(const ToolJacobian& jacobian, const Eigen::Quaterniond& orientation)
{
  const Eigen::Matrix3d tool_T_manipulator = orientation.toRotationMatrix().transpose();
  ToolJacobian own;
  own << tool_T_manipulator * jacobian.topRows<3>(), tool_T_manipulator * jacobian.bottomRows<3>();
  return own;
}

}  // namespace eyeslam::robot
