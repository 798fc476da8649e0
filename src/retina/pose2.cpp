// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/retina/pose2.h"

#include <cmath>

#include "eyeslam/retina/units.h"

namespace eyeslam::retina {

Eigen::Matrix2d Pose2::linear() const
{
  const double c = scale * std::cos(theta);
  const double s = scale * std::sin(theta);
  Eigen::Matrix2d result;
  result << c, -s, s, c;
  return result;
}

Pose2 Pose2::operator*(const Pose2& other) const
{
  const Eigen::Vector2d t = *this * other.translation();
  return {t.x(), t.y(), wrapAngle(theta + other.theta), scale * other.scale};
}

Pose2 Pose2::inverse() const
{
  Pose2 result{0.0, 0.0, -theta, 1.0 / scale};
  const Eigen::Vector2d t = -(result.linear() * translation());
  result.x = t.x();
  result.y = t.y();
  return result;
}

double wrapAngle(double theta)
{
  const double wrapped = std::remainder(theta, kTwoPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

}  // namespace eyeslam::retina
