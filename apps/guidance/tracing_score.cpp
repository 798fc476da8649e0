// SPDX-License-Identifier: GPL-3.0-or-later
#include "guidance/tracing_score.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/loop_period.h"
#include "eyeslam/simulation/random.h"

namespace eyeslam::apps {

namespace {

constexpr double kUm_per_px = 5.0;
constexpr double kHeight = 0.5e-3;
constexpr double kSettle_s = 4.0;
constexpr double kFar = 5e-3;       // nobody is farther off, m
constexpr double kYields = 600e-6;  // from here on a soft fixture yields more than lambda

struct Sums {
  double square = 0.0;
  std::int64_t left_behind = 0;
  std::vector<float> errors_um;
};

void look(const GuidedTracing& tracing, const TracingStep& step, const fixtures::CenterlineIndex& vessel,
          const GuidedTracingOptions& options, Sums& sums, TracingScore& score)
{
  const auto near = vessel.nearest(step.tip_retina.head<2>(), kFar);
  const double error = near ? near->distance : kFar;
  sums.square += error * error;
  sums.errors_um.push_back(static_cast<float>(error * kPerMicro));
  if (options.aid == Aid::none) return;
  const fixtures::FixtureOutput& fixture = tracing.fixture();
  if (fixture.reason == retina::Reason::speed_limited) ++sums.left_behind;
  if (!inForce(fixture)) return;
  score.in_force_max_um = std::max(score.in_force_max_um, error * kPerMicro);
  const double hand = (fixture.filtered_null.head<2>() - fixture.curve->anchor()).norm();
  const double goal = (step.tip_retina.head<2>() - fixture.curve->anchor()).norm();
  const double lambda = options.aid == Aid::soft ? options.lambda : 0.0;
  if (hand < kYields) score.law_max_um = std::max(score.law_max_um, std::abs(goal - lambda * hand) * kPerMicro);
}

float quantile(std::vector<float>& values, double share)
{
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

bool inForce(const fixtures::FixtureOutput& fixture)
{
  return fixture.curve != nullptr && fixture.handover == 0.0 && fixture.reason != retina::Reason::speed_limited;
}

std::vector<Eigen::Vector3d> studyPath(std::uint64_t seed, double height)
{
  constexpr std::uint64_t kStream = 90;
  simulation::Random random(seed, kStream);
  const double a = random.uniform(0.0, kTwoPi);
  std::vector<Eigen::Vector3d> path = simulation::sineVessel(a, random.uniform(0.0, kTwoPi));
  for (Eigen::Vector3d& point : path) point.z() = -height;
  return path;
}

fixtures::Vessel vesselThrough(const std::vector<Eigen::Vector3d>& points, double um_per_px)
{
  fixtures::Vessel vessel;
  for (const Eigen::Vector3d& place : points) {
    fixtures::CenterlinePoint point;
    point.position_px = place.head<2>() / (um_per_px * 1e-6);
    point.radius_px = 10.0;
    if (!vessel.points.empty()) {
      const fixtures::CenterlinePoint& last = vessel.points.back();
      point.s_px = last.s_px + (point.position_px - last.position_px).norm();
    }
    vessel.points.push_back(point);
  }
  for (std::size_t i = 0; i < vessel.points.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0;
    const std::size_t after = std::min(i + 1, vessel.points.size() - 1);
    vessel.points[i].tangent = (vessel.points[after].position_px - vessel.points[before].position_px).normalized();
  }
  return vessel;
}

TracingScore scoreTracing(const GuidedTracingOptions& options, std::uint64_t seeds, double seconds)
{
  TracingScore score;
  Sums all;
  double square_of_rms = 0.0;
  for (std::uint64_t i = 0; i < seeds; ++i) {
    GuidedTracingOptions seeded = options;
    seeded.seed += i;
    const auto path = studyPath(seeded.seed, kHeight);
    const auto vessel = std::make_shared<const fixtures::CenterlineIndex>(
        std::vector<fixtures::Vessel>{vesselThrough(path, kUm_per_px)}, kUm_per_px);
    GuidedTracing tracing(seeded, vessel, path, {1.5e-3, 0.0, 0.0});
    const std::size_t before = all.errors_um.size();
    all.square = 0.0;
    const auto steps = static_cast<int>(std::lround((kSettle_s + seconds) / simulation::kPeriod_s));
    for (int k = 0; k < steps; ++k) {
      const TracingStep& step = tracing.step();
      if (step.t_s >= kSettle_s) look(tracing, step, *vessel, seeded, all, score);
    }
    const double rms = kPerMicro * std::sqrt(all.square / static_cast<double>(all.errors_um.size() - before));
    score.rms_um += rms / static_cast<double>(seeds);
    square_of_rms += rms * rms / static_cast<double>(seeds);
  }
  score.rms_spread_um = std::sqrt(std::max(0.0, square_of_rms - score.rms_um * score.rms_um));
  score.left_behind = static_cast<double>(all.left_behind) / static_cast<double>(all.errors_um.size());
  score.median_um = quantile(all.errors_um, 0.5);
  score.p95_um = quantile(all.errors_um, 0.95);
  return score;
}

}  // namespace eyeslam::apps
