// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/eye_jerks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "eyeslam/retina/smoothstep.h"
#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

constexpr double kHomeward_rad = 0.5;  // how far from the way back a jerk that returns may point
constexpr std::uint64_t kJerkStream = 55;

}  // namespace

EyeJerks::EyeJerks(const RetinaMotionOptions& options, std::uint64_t seed)
    : rate_(options.jerks_per_s),
      shortest_(options.jerk_shortest_mm * kMilli),
      longest_(options.jerk_longest_mm * kMilli),
      duration_s_(options.jerk_ms * kMilli),
      turn_(options.jerk_rotation_deg * kDegree),
      reach_(options.reach_mm * kMilli),
      tool_share_(options.tool_jerk_share),
      random_(seed, kJerkStream)
{
  jerk_ = drawn(0.0);
}

EyeJerks::Jerk EyeJerks::drawn(double earliest_s)
{
  Jerk jerk;
  // The time between two beginnings is at least a jerk long; the rest of its mean is exponential, as of rare events.
  const double spare = rate_ > 0.0 ? std::max(0.0, 1.0 / rate_ - duration_s_) : 0.0;
  jerk.start_s =
      rate_ > 0.0 ? earliest_s - spare * std::log1p(-random_.uniform()) : std::numeric_limits<double>::infinity();
  const double length = random_.uniform(shortest_, longest_);
  double angle = random_.uniform(0.0, kTwoPi);
  const Eigen::Vector2d from = own_done_ + tool_done_;
  const Eigen::Vector2d to = from + length * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  if (to.norm() > reach_) angle = std::atan2(-from.y(), -from.x()) + random_.uniform(-kHomeward_rad, kHomeward_rad);
  jerk.way = length * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  jerk.theta = turn_ * random_.uniform(-1.0, 1.0);
  jerk.by_tool = random_.chance(tool_share_);
  return jerk;
}

void EyeJerks::advance(double t)
{
  while (t >= jerk_.start_s + duration_s_) {
    (jerk_.by_tool ? tool_done_ : own_done_) += jerk_.way;
    theta_done_ += jerk_.theta;
    jerk_ = drawn(jerk_.start_s + duration_s_);
  }
  under_way_ = t > jerk_.start_s;
  const double part = under_way_ ? retina::smoothstep((t - jerk_.start_s) / duration_s_) : 0.0;
  own_way_ = own_done_;
  tool_way_ = tool_done_;
  (jerk_.by_tool ? tool_way_ : own_way_) += part * jerk_.way;
  theta_ = theta_done_ + part * jerk_.theta;
}

}  // namespace eyeslam::simulation
