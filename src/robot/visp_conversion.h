// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <visp3/core/vpColVector.h>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/core/vpMatrix.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace eyeslam::robot {

vpColVector toVisp(const Eigen::VectorXd& vector);
vpMatrix toVisp(const Eigen::MatrixXd& matrix);
vpHomogeneousMatrix toVisp(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation);
/// (t, theta u), as vpPoseVector has it.
vpColVector poseVector(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation);

Eigen::VectorXd toEigen(const vpColVector& vector);
Eigen::MatrixXd toEigen(const vpMatrix& matrix);
Eigen::Isometry3d toEigen(const vpHomogeneousMatrix& pose);

}  // namespace eyeslam::robot
