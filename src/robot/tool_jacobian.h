// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "eyeslam/messaging/micron_messages.h"

namespace eyeslam::robot {

/// What a motion of the tip makes of the tool: rows 0-2 the velocity of the tip, 3-5 the tool's rate of turn, both in
/// the manipulator's axes; columns the tip's velocity. With a remote centre of motion the shaft turns about it, without
/// spin: rate = shaft x velocity / distance; without one the tool keeps its orientation.
using ToolJacobian = Eigen::Matrix<double, 6, 3>;

/// @param pivot  manipulator frame, m; none, or nearer to the tip than a millimetre: no turn
ToolJacobian toolJacobian(const Eigen::Vector3d& tip, const std::optional<Eigen::Vector3d>& pivot);

/// The same seen from the tool: both halves in the tool's own axes.
ToolJacobian inToolAxes(const ToolJacobian& jacobian, const Eigen::Quaterniond& orientation);

/// [v]x w = v x w.
Eigen::Matrix3d crossProduct(const Eigen::Vector3d& v);

}  // namespace eyeslam::robot
