// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/shaped_noise.h"

#include <cmath>

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

constexpr double kTimeConstants = 14.0;  // exp(-14) of the start is left: below 1e-6

// After so many samples a cascade has forgotten how it started.
int settlingSamples(double slowest_hz, double period_s)
{
  return static_cast<int>(std::ceil(kTimeConstants / (kPi * slowest_hz * period_s)));
}

}  // namespace

FilterSection FilterSection::lowPass(double corner_hz, double period_s)
{
  const double k = std::tan(kPi * corner_hz * period_s);
  const double norm = 1.0 / (1.0 + std::sqrt(2.0) * k + k * k);
  FilterSection section;
  section.b0_ = section.b2_ = k * k * norm;
  section.b1_ = 2.0 * section.b0_;
  section.a1_ = 2.0 * (k * k - 1.0) * norm;
  section.a2_ = (1.0 - std::sqrt(2.0) * k + k * k) * norm;
  return section;
}

FilterSection FilterSection::bandPass(double centre_hz, double width_hz, double period_s)
{
  const double k = std::tan(kPi * centre_hz * period_s);
  const double damping = k * width_hz / centre_hz;
  const double norm = 1.0 / (1.0 + damping + k * k);
  FilterSection section;
  section.b0_ = damping * norm;
  section.b2_ = -section.b0_;
  section.b1_ = 0.0;
  section.a1_ = 2.0 * (k * k - 1.0) * norm;
  section.a2_ = (1.0 - damping + k * k) * norm;
  return section;
}

FilterSection FilterSection::lag(double time_s, double period_s)
{
  const double kept = std::exp(-period_s / time_s);
  FilterSection section;
  section.b0_ = 1.0 - kept;
  section.a1_ = -kept;
  return section;
}

double FilterSection::step(double input)
{
  const double output = b0_ * input + first_;
  first_ = b1_ * input - a1_ * output + second_;
  second_ = b2_ * input - a2_ * output;
  return output;
}

void FilterSection::hold(double input)
{
  const double output = input * (b0_ + b1_ + b2_) / (1.0 + a1_ + a2_);
  second_ = b2_ * input - a2_ * output;
  first_ = b1_ * input - a1_ * output + second_;
}

double step(FilterCascade& cascade, double input) { return cascade[2].step(cascade[1].step(cascade[0].step(input))); }

NoiseGain noiseGain(FilterCascade cascade, double slowest_hz, double period_s)
{
  double square = 0.0;
  double rate_square = 0.0;
  double last = 0.0;
  const int samples = settlingSamples(slowest_hz, period_s);
  for (int i = 0; i < samples; ++i) {
    const double response = step(cascade, i == 0 ? 1.0 : 0.0);
    square += response * response;
    rate_square += (response - last) * (response - last);
    last = response;
  }
  return {std::sqrt(square), std::sqrt(rate_square) / period_s};
}

ShapedNoise::ShapedNoise(const FilterCascade& cascade, double slowest_hz, double period_s, Random random)
    : cascade_(cascade), gain_(noiseGain(cascade, slowest_hz, period_s)), random_(random)
{
  const int samples = settlingSamples(slowest_hz, period_s);
  for (int i = 0; i < samples; ++i) step();
}

ShapedNoise ShapedNoise::lowPass(double corner_hz, double period_s, Random random)
{
  return {{FilterSection::lowPass(corner_hz, period_s), {}, {}}, corner_hz, period_s, random};
}

ShapedNoise ShapedNoise::bandPass(double centre_hz, double width_hz, double period_s, Random random)
{
  const FilterSection section = FilterSection::bandPass(centre_hz, width_hz, period_s);
  return {{section, section, {}}, width_hz, period_s, random};
}

double ShapedNoise::step() { return simulation::step(cascade_, random_.normal()) / gain_.rms; }

}  // namespace eyeslam::simulation
