// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/body_cycle.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

constexpr int kSamples = 720;  // of one period, to find its peak: half a degree is 4e-5 of the peak at most

}  // namespace

BodyCycle::BodyCycle(double hz, int harmonics, Random& random) : hz_(hz)
{
  for (std::size_t i = 0; i < std::min<std::size_t>(static_cast<std::size_t>(harmonics), amplitudes_.size()); ++i) {
    const double weaker = i == 0 ? 1.0 : random.uniform(0.2, 0.5) / static_cast<double>(i);
    amplitudes_[i] = weaker;
    phases_[i] = random.uniform(0.0, kTwoPi);
  }
  double peak = 0.0;
  for (int i = 0; i < kSamples; ++i) peak = std::max(peak, std::abs(at(i / (hz_ * kSamples))));
  for (double& amplitude : amplitudes_) amplitude /= peak;
}

double BodyCycle::at(double t) const
{
  double sum = 0.0;
  for (std::size_t i = 0; i < amplitudes_.size(); ++i) {
    sum += amplitudes_[i] * std::sin(kTwoPi * hz_ * static_cast<double>(i + 1) * t + phases_[i]);
  }
  return sum;
}

}  // namespace eyeslam::simulation
