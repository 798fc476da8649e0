// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "eyeslam/simulation/random.h"

namespace eyeslam::simulation {

/// A periodic motion of a few harmonics, as breathing and pulse are; its largest value is 1.
class BodyCycle {
 public:
  /// @param harmonics  1 to 3, each weaker than the last; phases and strengths are drawn
  BodyCycle(double hz, int harmonics, Random& random);

  double at(double t_s) const;
  double hz() const { return hz_; }

 private:
  double hz_;
  std::array<double, 3> amplitudes_{}, phases_{};
};

}  // namespace eyeslam::simulation
