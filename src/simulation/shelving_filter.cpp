// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/shelving_filter.h"

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

ShelvingFilter::ShelvingFilter(const ShelvingFilterOptions& options, double period_s) : passed_(options.passed)
{
  for (auto& axis : poles_) axis.fill(FilterSection::lag(1.0 / (kTwoPi * options.corner_hz), period_s));
}

void ShelvingFilter::hold(const Eigen::Vector3d& input)
{
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (FilterSection& pole : poles_[static_cast<std::size_t>(i)]) pole.hold(input[i]);
  }
}

Eigen::Vector3d ShelvingFilter::step(const Eigen::Vector3d& input)
{
  Eigen::Vector3d slow;
  for (Eigen::Index i = 0; i < 3; ++i) {
    auto& [first, second] = poles_[static_cast<std::size_t>(i)];
    slow[i] = second.step(first.step(input[i]));
  }
  return slow + passed_ * (input - slow);
}

}  // namespace eyeslam::simulation
