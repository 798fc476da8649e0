// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/micron_model.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/shortened.h"

namespace eyeslam::simulation {

namespace {

constexpr std::uint64_t kNoise = 70, kDrawnGains = 71, kFirstBend = 72;  // streams of the seed

// A command is held for a period, so the middle of its effect comes half a period later than its start.
std::size_t delaySubsteps(double delay_periods, int substeps, std::size_t most)
{
  const long start = std::lround((delay_periods - 0.5) * substeps);
  return std::min(most - 1, static_cast<std::size_t>(std::max(start, 0L)));
}

}  // namespace

MicronModel::MicronModel(const MicronOptions& options, std::uint64_t seed, double period_s)
    : options_(options),
      period_s_(period_s),
      rate_(kTwoPi * options.bandwidth_hz),
      delay_(delaySubsteps(options.delay_ms * kMilli / period_s, kSubsteps, kCommands)),
      noise_(seed, kNoise),
      bend_{ShapedNoise::lowPass(options.bend_hz, period_s, Random(seed, kFirstBend)),
            ShapedNoise::lowPass(options.bend_hz, period_s, Random(seed, kFirstBend + 1)),
            ShapedNoise::lowPass(options.bend_hz, period_s, Random(seed, kFirstBend + 2))}
{
  Random random(seed, kDrawnGains);
  for (double& gain : gain_.reshaped()) gain = 1.0 + (random.chance(0.5) ? 1.0 : -1.0) * options.gain_error;
  commands_.fill(Eigen::Vector3d::Zero());
}

void MicronModel::commandDeflection(const Eigen::Vector3d& deflection)
{
  command_ = deflection;
  command_is_tip_ = false;
}

void MicronModel::commandTip(const Eigen::Vector3d& goal)
{
  command_ = goal;
  command_is_tip_ = true;
}

double MicronModel::lead() const { return options_.delay_ms * kMilli + 2.0 * options_.damping / rate_; }

const MicronReading& MicronModel::state() const
{
  const std::int64_t age = std::min(std::llround(options_.state_age_ms * kMilli / period_s_), periods_ - 1LL);
  return readings_[static_cast<std::size_t>(periods_ - std::max<std::int64_t>(age, 0)) % kReadings];
}

void MicronModel::measure(const Eigen::Vector3d& null, const Eigen::Vector2d& port)
{
  const double size = options_.noise_um * kMicro;
  const auto noise = [&]() -> Eigen::Vector3d {
    return Eigen::Vector3d(noise_.normal(), noise_.normal(), noise_.normal()) * size;
  };
  MicronReading& reading = readings_[static_cast<std::size_t>(periods_) % kReadings];
  reading.periods = periods_;
  reading.null = null + noise();
  reading.tip = null + deflection() + noise();
  reading.port = port + noise().head<2>();
}

Eigen::Vector3d MicronModel::wanted() const
{
  if (!command_is_tip_) return command_;
  return command_ - fresh().null;
}

Eigen::Vector3d MicronModel::withinReach(const Eigen::Vector3d& way) const
{
  const double lateral = options_.reach_mm * kMilli;
  if (shaft_.isZero(0.0)) return shortened(way, lateral);
  const double along = way.dot(shaft_);
  const double axial = options_.reach_axial_mm * kMilli;
  const Eigen::Vector3d across = way - along * shaft_;
  if (across.norm() <= lateral && std::abs(along) <= axial) return way;
  return shortened(across, lateral) + std::clamp(along, -axial, axial) * shaft_;
}

MicronLimits MicronModel::outOfReach(const Eigen::Vector3d& way) const
{
  const double lateral = options_.reach_mm * kMilli;
  MicronLimits limits;
  if (shaft_.isZero(0.0)) {
    limits.lateral = limits.axial = way.norm() > lateral;
  } else {
    limits.lateral = (way - way.dot(shaft_) * shaft_).norm() > lateral;
    limits.axial = std::abs(way.dot(shaft_)) > options_.reach_axial_mm * kMilli;
  }
  return limits;
}

void MicronModel::actuate(const Eigen::Vector3d& target, double time_s)
{
  const Eigen::Vector3d pull = rate_ * rate_ * (target - position_) - 2.0 * options_.damping * rate_ * velocity_;
  limits_.acceleration |= pull.norm() > options_.acceleration_m_s2;
  const Eigen::Vector3d faster = velocity_ + time_s * shortened(pull, options_.acceleration_m_s2);
  limits_.speed |= faster.norm() > options_.speed_mm_s * kMilli;
  velocity_ = shortened(faster, options_.speed_mm_s * kMilli);
  const Eigen::Vector3d tip_velocity = velocity_ + hand_velocity_;
  if (tip_velocity.norm() > tip_speed_) {
    limits_.speed = true;
    velocity_ = shortened(tip_velocity, tip_speed_) - hand_velocity_;
  }
  const Eigen::Vector3d moved = position_ + time_s * velocity_;
  position_ = withinReach(moved);
  if (position_ != moved) velocity_ = (position_ - (moved - time_s * velocity_)) / time_s;
}

void MicronModel::step(const Eigen::Vector3d& null, const Eigen::Vector2d& port)
{
  // The command holds from the last step to this one; a controller that subtracts the null does so once a period.
  const Eigen::Vector3d asked = periods_ == 0 ? Eigen::Vector3d::Zero() : wanted();
  const Eigen::Vector3d target = withinReach(asked);
  limits_ = outOfReach(asked);
  for (int i = 0; i < kSubsteps; ++i) {
    commands_[next_command_] = target;
    actuate(commands_[(next_command_ + kCommands - delay_) % kCommands], period_s_ / kSubsteps);
    next_command_ = (next_command_ + 1) % kCommands;
  }
  ++periods_;
  Eigen::Vector3d bent;
  for (Eigen::Index i = 0; i < 3; ++i) bent[i] = bend_[static_cast<std::size_t>(i)].step() * options_.bend_um * kMicro;
  tip_ = null + deflection() + bent;
  measure(null, port);
}

}  // namespace eyeslam::simulation
