// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/hand_tremor.h"

#include <algorithm>

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

constexpr std::uint64_t kDrawnSizes = 40;  // stream of what is drawn once
constexpr std::uint64_t kFirstAxis = 41;   // three streams per axis from here on

Random stream(std::uint64_t seed, int axis, int part)
{
  return Random(seed, kFirstAxis + static_cast<std::uint64_t>(3 * axis + part));
}

}  // namespace

HandTremor::Axis HandTremor::axis(const HandTremorOptions& options, std::uint64_t seed, int number, double period_s)
{
  return {ShapedNoise::bandPass(options.tremor_hz, options.tremor_width_hz, period_s, stream(seed, number, 0)),
          ShapedNoise::lowPass(options.drift_hz, period_s, stream(seed, number, 1)),
          ShapedNoise::lowPass(options.lean_hz, period_s, stream(seed, number, 2))};
}

HandTremor::HandTremor(const HandTremorOptions& options, std::uint64_t seed, double period_s)
    : tremor_rms_(0.0),
      drift_rms_(0.0),
      lean_rms_(options.lean_um * kMicro),
      lean_step_(options.lean_rise_s > period_s ? period_s / options.lean_rise_s : 1.0),
      axes_{axis(options, seed, 0, period_s), axis(options, seed, 1, period_s), axis(options, seed, 2, period_s)}
{
  Random random(seed, kDrawnSizes);
  tremor_rms_ = random.uniform(options.tremor_low_um, options.tremor_high_um) * kMicro;
  drift_rms_ = random.uniform(options.drift_low_um, options.drift_high_um) * kMicro;
}

const HandTremor::Displacement& HandTremor::step(Support support)
{
  lean_part_ = std::clamp(lean_part_ + (support == Support::fixture ? lean_step_ : -lean_step_), 0.0, 1.0);
  for (Eigen::Index i = 0; i < 3; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    displacement_.tremor[i] = tremor_rms_ * axis.tremor.step();
    displacement_.drift[i] = drift_rms_ * axis.drift.step();
    displacement_.lean[i] = lean_part_ * lean_rms_ * axis.lean.step();
  }
  return displacement_;
}

}  // namespace eyeslam::simulation
