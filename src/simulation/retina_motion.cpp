// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/retina_motion.h"

#include <cmath>

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

constexpr double kTurn_hz = 0.15;
constexpr double kAxial_hz = 5.0;
// Streams of the seed, one a part, so that a change in one leaves the others as they were.
constexpr std::uint64_t kSpeed = 60, kUnseen = 61, kTurn = 63, kAxial = 64, kBreath = 65, kPulse = 66, kWays = 67;

double drawnSpeed(const RetinaMotionOptions& options, std::uint64_t seed)
{
  return kMilli * Random(seed, kSpeed).uniform(options.speed_low_mm_s, options.speed_high_mm_s);
}

ShapedNoise unseenNoise(const RetinaMotionOptions& options, std::uint64_t seed, std::uint64_t axis, double period_s)
{
  return ShapedNoise::lowPass(options.unseen_hz, period_s, Random(seed, kUnseen + axis));
}

BodyCycle breath(const RetinaMotionOptions& options, std::uint64_t seed)
{
  Random random(seed, kBreath);
  return {options.breath_hz * random.uniform(0.9, 1.1), 2, random};
}

BodyCycle pulse(std::uint64_t seed)
{
  Random random(seed, kPulse);
  return {random.uniform(0.9, 1.25), 3, random};
}

// Across the view in a drawn direction by a drawn peak, and along the line of sight.
Eigen::Vector3d drawnWay(double low_um, double high_um, double axial_um, Random& random)
{
  const double across = random.uniform(low_um, high_um);
  const double angle = random.uniform(0.0, kTwoPi);
  return kMicro * Eigen::Vector3d(across * std::cos(angle), across * std::sin(angle), axial_um);
}

Eigen::Vector3d breathWay(const RetinaMotionOptions& options, std::uint64_t seed)
{
  Random random(seed, kWays);
  return drawnWay(options.breath_low_um, options.breath_high_um, options.breath_axial_um, random);
}

Eigen::Vector3d pulseWay(const RetinaMotionOptions& options, std::uint64_t seed)
{
  Random random(seed, kWays + 1);
  return drawnWay(options.pulse_low_um, options.pulse_high_um, options.pulse_axial_um, random);
}

}  // namespace

RetinaMotion::RetinaMotion(const RetinaMotionOptions& options, std::uint64_t seed, const Eigen::Vector3d& centre,
                           double period_s)
    : period_s_(period_s),
      speed_(drawnSpeed(options, seed)),
      coupling_(options, speed_ * std::sqrt(options.hand_share), seed, period_s),
      jerks_(options, seed),
      unseen_noise_{unseenNoise(options, seed, 0, period_s), unseenNoise(options, seed, 1, period_s)},
      turn_noise_(ShapedNoise::lowPass(kTurn_hz, period_s, Random(seed, kTurn))),
      axial_noise_(ShapedNoise::lowPass(kAxial_hz, period_s, Random(seed, kAxial))),
      breath_(breath(options, seed)),
      pulse_(pulse(seed)),
      breath_way_(breathWay(options, seed)),
      pulse_way_(pulseWay(options, seed)),
      unseen_rms_(speed_ * std::sqrt((1.0 - options.hand_share) / 2.0) / unseen_noise_[0].rateRms()),
      turn_rms_(options.rotation_deg * kDegree),
      axial_rms_(options.axial_noise_um * kMicro)
{
  state_.world_T_retina.centre = centre;
}

Eigen::Vector3d RetinaMotion::shift() const
{
  const Eigen::Vector2d across = coupling_.retina() + jerks_.ownWay();
  return slow_ + Eigen::Vector3d(across.x(), across.y(), 0.0) + breath_.at(t_) * breath_way_ +
         pulse_.at(t_) * pulse_way_;
}

void RetinaMotion::advance(const HandState& hand)
{
  jerks_.advance(t_);
  coupling_.step(hand, jerks_.toolWay());
  slow_ = {unseen_rms_ * unseen_noise_[0].step(), unseen_rms_ * unseen_noise_[1].step(),
           axial_rms_ * axial_noise_.step()};
  turn_ = turn_rms_ * turn_noise_.step() + jerks_.theta();
}

const RetinaState& RetinaMotion::step(const HandState& hand)
{
  if (started_) t_ += period_s_;
  advance(hand);
  if (!started_) {
    coupling_.settle();
    first_shift_ = shift();
    first_turn_ = turn_;
    started_ = true;
  }
  state_.world_T_retina.shift = shift() - first_shift_;
  state_.world_T_retina.theta = turn_ - first_turn_;
  state_.port = coupling_.port();
  return state_;
}

}  // namespace eyeslam::simulation
