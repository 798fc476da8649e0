// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/eye_motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

constexpr double kBreath_hz = 0.25;
constexpr double kPulse_hz = 1.1;
constexpr double kJump_s = 0.045;

double radians(double deg) { return deg * kPi / 180.0; }

// Minimum-jerk step (Flash and Hogan 1985): 0 before, 1 after, smooth between.
double smoothStep(double t)
{
  const double s = std::clamp(t, 0.0, 1.0);
  return s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
}

EyeMotionOptions jerkyEyeMotion()
{
  EyeMotionOptions options;
  options.drift_px = 60.0;
  options.rotation_deg = 2.5;
  options.jerk_interval_s = 1.5;
  return options;
}

EyeMotionOptions saccadeEyeMotion()
{
  EyeMotionOptions options;
  options.drift_px = 8.0;
  options.rotation_deg = 1.0;
  options.jerk_interval_s = 1.1;
  options.jerk_shortest_px = 100.0;
  options.jerk_longest_px = 260.0;
  options.jerk_ms = 45.0;
  options.jerk_rotation_deg = 0.6;
  options.reach_px = 190.0;
  return options;
}

EyeMotionOptions inSituEyeMotion()
{
  EyeMotionOptions options;
  options.drift_px = 20.0;
  options.rotation_deg = 1.0;
  options.breath_px = 12.0;
  options.pulse_px = 2.0;
  options.jerk_interval_s = 4.0;
  options.jerk_longest_px = 40.0;
  return options;
}

EyeMotionOptions excursionEyeMotion()
{
  EyeMotionOptions options;
  options.drift_px = 12.0;
  options.rotation_deg = 1.5;
  options.excursion_px = 600.0;
  return options;
}

EyeMotionOptions scalingEyeMotion()
{
  EyeMotionOptions options;
  options.scale_change = 0.06;
  options.warp_px = 2.0;
  return options;
}

}  // namespace

const std::vector<const char*>& eyeMotionNames()
{
  static const std::vector<const char*> names = {"smooth", "jerky", "saccade", "in_situ", "excursion", "scaling"};
  return names;
}

EyeMotionOptions eyeMotionOptions(const std::string& name)
{
  if (name == "smooth") return {};
  if (name == "jerky") return jerkyEyeMotion();
  if (name == "saccade") return saccadeEyeMotion();
  if (name == "in_situ") return inSituEyeMotion();
  if (name == "excursion") return excursionEyeMotion();
  if (name == "scaling") return scalingEyeMotion();
  throw std::invalid_argument("motion '" + name +
                              "' is not known; smooth, jerky, saccade, in_situ, excursion and scaling are");
}

double EyeMotion::Wave::at(double t) const { return amplitude * std::sin(kTwoPi * hz * t + phase); }

EyeMotion::EyeMotion(const EyeMotionOptions& options, double px_scale, double duration_s, std::uint64_t seed)
    : options_(options), px_scale_(px_scale)
{
  Random random(seed, 11);
  for (std::vector<Wave>* axis : {&x_, &y_}) {
    addWaves(*axis, options.drift_px * px_scale, options.drift_hz, 3, random);
    addWaves(*axis, options.tremor_px * px_scale, options.tremor_hz, 2, random);
    axis->push_back({options.breath_px * px_scale * random.uniform(0.3, 1.0), kBreath_hz, random.uniform(0.0, kTwoPi)});
    axis->push_back({options.pulse_px * px_scale * random.uniform(0.3, 1.0), kPulse_hz, random.uniform(0.0, kTwoPi)});
  }
  addWaves(theta_, radians(options.rotation_deg), 0.6 * options.drift_hz, 2, random);
  excursion_angle_ = radians(random.uniform(-25.0, 25.0)) + (random.chance(0.5) ? kPi : 0.0);
  for (Wave& wave : warp_) {
    wave = {options.warp_px * px_scale * random.uniform(0.4, 1.0), random.uniform(0.06, 0.18),
            random.uniform(0.0, kTwoPi)};
  }
  planJerks(duration_s, random);
  start_ = raw(0.0);
}

void EyeMotion::addWaves(std::vector<Wave>& waves, double amplitude, double hz, int count, Random& random)
{
  for (int i = 0; i < count; ++i) {
    const double frequency = hz * std::pow(1.8, i - (count - 1) / 2.0) * random.uniform(0.85, 1.15);
    // Slower waves reach farther, as in a random walk.
    waves.push_back(
        {amplitude * std::pow(1.8, -0.6 * i) * random.uniform(0.6, 1.1), frequency, random.uniform(0.0, kTwoPi)});
  }
}

void EyeMotion::planJerks(double duration_s, Random& random)
{
  if (options_.jerk_interval_s <= 0.0) return;
  double x = 0.0;
  double y = 0.0;
  double t = options_.jerk_interval_s * random.uniform(0.5, 1.0);
  while (t < duration_s) {
    const double length = px_scale_ * random.uniform(options_.jerk_shortest_px, options_.jerk_longest_px);
    double angle = random.uniform(0.0, kTwoPi);
    if (std::hypot(x + length * std::cos(angle), y + length * std::sin(angle)) > options_.reach_px * px_scale_) {
      angle = std::atan2(-y, -x) + random.uniform(-0.5, 0.5);
    }
    const double dx = length * std::cos(angle);
    const double dy = length * std::sin(angle);
    const double seconds = options_.jerk_ms * 1e-3 * random.uniform(0.8, 1.2);
    jerks_.push_back({t, seconds, dx, dy, radians(options_.jerk_rotation_deg) * random.uniform(-1.0, 1.0)});
    x += dx;
    y += dy;
    t += options_.jerk_interval_s * random.uniform(0.6, 1.4);
  }
}

void EyeMotion::addJump(double t_s, double length_px, double angle)
{
  jerks_.push_back({t_s, kJump_s, length_px * std::cos(angle), length_px * std::sin(angle), 0.0});
}

retina::Pose2 EyeMotion::raw(double t) const
{
  retina::Pose2 pose;
  for (const Wave& wave : x_) pose.x += wave.at(t);
  for (const Wave& wave : y_) pose.y += wave.at(t);
  for (const Wave& wave : theta_) pose.theta += wave.at(t);
  for (const Jerk& jerk : jerks_) {
    const double part = smoothStep((t - jerk.start_s) / jerk.duration_s);
    pose.x += part * jerk.x;
    pose.y += part * jerk.y;
    pose.theta += part * jerk.theta;
  }
  // Out to one side, back through the start, out to the other side.
  const double turn = kPi * t / options_.excursion_period_s;
  const double out = options_.excursion_px * px_scale_ * std::sin(turn) * std::abs(std::sin(turn));
  pose.x += out * std::cos(excursion_angle_);
  pose.y += std::abs(out) * std::sin(excursion_angle_);
  pose.scale = 1.0 + options_.scale_change * std::sin(kTwoPi * t / options_.scale_period_s);
  return pose;
}

retina::Pose2 EyeMotion::at(double t) const
{
  retina::Pose2 pose = raw(t);
  pose.x -= start_.x;
  pose.y -= start_.y;
  pose.theta -= start_.theta;
  return pose;
}

std::array<double, 6> EyeMotion::warpAt(double t) const
{
  const double half_width = 400.0 * px_scale_;
  std::array<double, 6> coefficients{};
  for (std::size_t i = 0; i < warp_.size(); ++i) {
    coefficients[i] = (warp_[i].at(t) - warp_[i].at(0.0)) / (half_width * half_width);
  }
  return coefficients;
}

}  // namespace eyeslam::simulation
