// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/port_coupling.h"

#include <Eigen/Geometry>
#include <cmath>

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

constexpr double kEasing = 0.1;  // of the wandering's time: a first-order wander alone is rough, like a random walk
constexpr std::uint64_t kPortStream = 50;  // gain, turn and wandering; the port's noise on the next two

ShapedNoise portNoise(const RetinaMotionOptions& options, std::uint64_t seed, int axis, double period_s)
{
  return ShapedNoise::lowPass(options.port_hz, period_s,
                              Random(seed, kPortStream + 1 + static_cast<std::uint64_t>(axis)));
}

FilterCascade globe(const RetinaMotionOptions& options, double period_s)
{
  const FilterSection pole = FilterSection::lag(options.port_lag_ms * 1e-3, period_s);
  return {pole, pole, {}};
}

// RMS speed behind the globe's lag of noise at the port of unit RMS, 1/s.
double laggedRate(const RetinaMotionOptions& options, double period_s)
{
  const FilterSection corner = FilterSection::lowPass(options.port_hz, period_s);
  const FilterCascade poles = globe(options, period_s);
  const NoiseGain at_port = noiseGain({corner, {}, {}}, options.port_hz, period_s);
  return noiseGain({corner, poles[0], poles[1]}, options.port_hz, period_s).rate_rms / at_port.rms;
}

}  // namespace

PortCoupling::PortCoupling(const RetinaMotionOptions& options, double speed, std::uint64_t seed, double period_s)
    : tremor_part_(options.port_tremor),
      travel_part_(options.port_travel),
      noise_{portNoise(options, seed, 0, period_s), portNoise(options, seed, 1, period_s)},
      globe_{globe(options, period_s), globe(options, period_s)},
      wander_rms_(options.port_wander),
      wander_kept_(std::exp(-period_s / options.port_wander_s)),
      wander_eased_(1.0 - std::exp(-period_s / (kEasing * options.port_wander_s))),
      random_(seed, kPortStream)
{
  gain_ = options.port_gain * (1.0 + options.port_gain_spread * random_.uniform(-1.0, 1.0));
  turn_ = options.port_turn_deg * kDegree * random_.uniform(-1.0, 1.0);
  for (std::size_t i = 0; i < wander_.size(); ++i) rough_[i] = wander_[i] = wander_rms_ * random_.normal();
  // Both axes share the speed; what wanders adds to its square.
  const double per_axis = speed / std::sqrt(2.0 * (1.0 + wander_rms_ * wander_rms_));
  if (gain_ > 0.0) noise_rms_ = per_axis / (gain_ * laggedRate(options, period_s));
}

void PortCoupling::wander()
{
  // The easing takes its part of the variance away: 1 / (1 + kEasing) is left.
  const double rms = wander_rms_ * std::sqrt(1.0 + kEasing);
  const double fresh = rms * std::sqrt(1.0 - wander_kept_ * wander_kept_);
  for (std::size_t i = 0; i < wander_.size(); ++i) {
    rough_[i] = wander_kept_ * rough_[i] + fresh * random_.normal();
    wander_[i] += wander_eased_ * (rough_[i] - wander_[i]);
  }
}

Eigen::Matrix2d PortCoupling::wanderedGain() const
{
  return gain_ * (1.0 + wander_[0]) * Eigen::Rotation2Dd(turn_ + wander_[1]).toRotationMatrix();
}

void PortCoupling::step(const HandState& hand, const Eigen::Vector2d& pulled)
{
  wander();
  const Eigen::Matrix2d gain = wanderedGain();
  port_ = tremor_part_ * hand.tremor.head<2>() + travel_part_ * hand.travel.head<2>();
  for (Eigen::Index i = 0; i < 2; ++i) port_[i] += noise_rms_ * noise_[static_cast<std::size_t>(i)].step();
  if (gain_ > 0.0 && !pulled.isZero()) port_ -= Eigen::Rotation2Dd(-turn_).toRotationMatrix() * pulled / gain_;
  Eigen::Vector2d followed;
  for (Eigen::Index i = 0; i < 2; ++i) followed[i] = simulation::step(globe_[static_cast<std::size_t>(i)], port_[i]);
  retina_ = -(gain * followed);
}

void PortCoupling::settle()
{
  for (std::size_t i = 0; i < globe_.size(); ++i) {
    for (const std::size_t pole : {0U, 1U}) globe_[i][pole].hold(port_[static_cast<Eigen::Index>(i)]);
  }
  retina_ = -(wanderedGain() * port_);
}

}  // namespace eyeslam::simulation
