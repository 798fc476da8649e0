// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

#include "eyeslam/simulation/micron_controller_options.h"
#include "eyeslam/simulation/shaped_noise.h"

namespace eyeslam::simulation {

/// passed x input + (1 - passed) x two equal poles of the input, per axis; starts at rest. Never allocates.
class ShelvingFilter {
 public:
  ShelvingFilter(const ShelvingFilterOptions& options, double period_s);

  /// As if the input had lasted for ever.
  void hold(const Eigen::Vector3d& input);
  /// One period later.
  Eigen::Vector3d step(const Eigen::Vector3d& input);

 private:
  double passed_;
  std::array<std::array<FilterSection, 2>, 3> poles_;
};

}  // namespace eyeslam::simulation
