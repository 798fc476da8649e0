// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/plant_inverse.h"

#include "eyeslam/retina/units.h"
#include "eyeslam/servo/square.h"

namespace eyeslam::servo {

namespace {

constexpr int kTerms = 40;  // of the exponential's series: at 1000 Hz and 1 ms the last is below 1e-12

}  // namespace

PlantInverse::PlantInverse(const PlantInverseOptions& options, double period_s)
    : active_(options.response_hz > 0.0),
      plant_lead_(2.0 * options.plant_damping / (kTwoPi * options.plant_hz)),
      response_lead_(active_ ? 2.0 * options.response_damping / (kTwoPi * options.response_hz) : 0.0),
      plant_square_(square(kTwoPi * options.plant_hz)),
      response_square_(square(kTwoPi * options.response_hz)),
      half_(step(0.5 * period_s)),
      whole_(step(period_s))
{}

// Exact for an input that is held: the exponential of [A b; 0 0].
PlantInverse::Step PlantInverse::step(double time_s) const
{
  Eigen::Matrix3d rates = Eigen::Matrix3d::Zero();
  rates(0, 1) = 1.0;
  rates(1, 0) = -response_square_;
  rates(1, 1) = -response_square_ * response_lead_;
  rates(1, 2) = response_square_;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d term = sum;
  for (int i = 1; i <= kTerms; ++i) {
    term = (term * rates * (time_s / i)).eval();
    sum += term;
  }
  return {sum.topLeftCorner<2, 2>(), sum.topRightCorner<2, 1>()};
}

void PlantInverse::standAt(const Eigen::Vector3d& deflection) noexcept
{
  state_.row(0) = deflection.transpose();
  state_.row(1).setZero();
}

Eigen::Vector3d PlantInverse::shape(const Eigen::Vector3d& deflection) noexcept
{
  if (!active_) return deflection;
  // The command is held: what fits is what the plant needs in the middle of that time.
  const Eigen::Matrix<double, 2, 3> middle = half_.free * state_ + half_.forced * deflection.transpose();
  state_ = (whole_.free * state_ + whole_.forced * deflection.transpose()).eval();
  const Eigen::RowVector3d acceleration =
      response_square_ * (deflection.transpose() - middle.row(0) - response_lead_ * middle.row(1));
  return (middle.row(0) + plant_lead_ * middle.row(1) + acceleration / plant_square_).transpose();
}

}  // namespace eyeslam::servo
