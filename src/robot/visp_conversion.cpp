// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/robot/visp_conversion.h"

namespace eyeslam::robot {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

vpColVector toVisp(const Eigen::VectorXd& vector)
{
  vpColVector copy(static_cast<unsigned>(vector.size()));
  for (Eigen::Index i = 0; i < vector.size(); ++i) copy[static_cast<unsigned>(i)] = vector[i];
  return copy;
}

vpMatrix toVisp(const Eigen::MatrixXd& matrix)
{
  vpMatrix copy(static_cast<unsigned>(matrix.rows()), static_cast<unsigned>(matrix.cols()));
  Eigen::Map<RowMajor>(copy.data, matrix.rows(), matrix.cols()) = matrix;
  return copy;
}

vpHomogeneousMatrix toVisp(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation)
{
  const Eigen::Matrix3d rotation = orientation.toRotationMatrix();
  vpHomogeneousMatrix pose;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 3; ++column) pose[row][column] = rotation(row, column);
    pose[row][3] = position[row];
  }
  return pose;
}

vpColVector poseVector(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation)
{
  const Eigen::AngleAxisd turn(orientation);
  Eigen::VectorXd pose(6);
  pose << position, turn.angle() * turn.axis();
  return toVisp(pose);
}

Eigen::VectorXd toEigen(const vpColVector& vector)
{
  return Eigen::Map<const Eigen::VectorXd>(vector.data, static_cast<Eigen::Index>(vector.size()));
}

Eigen::MatrixXd toEigen(const vpMatrix& matrix)
{
  return Eigen::Map<const RowMajor>(matrix.data, static_cast<Eigen::Index>(matrix.getRows()),
                                    static_cast<Eigen::Index>(matrix.getCols()));
}

Eigen::Isometry3d toEigen(const vpHomogeneousMatrix& pose)
{
  Eigen::Isometry3d copy = Eigen::Isometry3d::Identity();
  copy.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(pose.data);
  return copy;
}

}  // namespace eyeslam::robot
