// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/trace_task.h"

#include <memory>
#include <utility>

#include "eyeslam/fixtures/virtual_fixtures.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/random.h"

namespace eyeslam::trials {

namespace {

constexpr double kUmPerPx = 5.0;        // loop study, section 1
constexpr double kSpeed = 0.4e-3;       // m/s, loop study, section 1
constexpr double kRadius_px = 10.0;     // a vein of 100 um, facts D4
constexpr double kHalfLength = 1.5e-3;  // m, of the path in x
constexpr double kFarthest = 5e-3;      // m, that an error is looked for
constexpr std::uint64_t kMap = 1;
constexpr std::uint64_t kPath = 90;  // stream of the seed

fixtures::Vessel vesselOf(const std::vector<Eigen::Vector3d>& path)
{
  fixtures::Vessel vessel;
  for (const Eigen::Vector3d& place : path) {
    fixtures::CenterlinePoint point;
    point.position_px = place.head<2>() / (kUmPerPx * 1e-6);
    point.radius_px = kRadius_px;
    const Eigen::Vector2d way = vessel.points.empty()
                                    ? Eigen::Vector2d::Zero()
                                    : Eigen::Vector2d(point.position_px - vessel.points.back().position_px);
    if (!vessel.points.empty()) {
      point.s_px = vessel.points.back().s_px + way.norm();
      point.tangent = way.normalized();
    }
    vessel.points.push_back(point);
  }
  vessel.points.front().tangent = vessel.points[1].tangent;
  return vessel;
}

}  // namespace

LoopTask traceTask(std::uint64_t seed, double lambda)
{
  simulation::Random random(seed, kPath);
  const double a = random.uniform(0.0, kTwoPi);
  std::vector<Eigen::Vector3d> points = simulation::sineVessel(a, random.uniform(0.0, kTwoPi));
  for (Eigen::Vector3d& point : points) point.x() -= kHalfLength;
  const auto vessels =
      std::make_shared<const fixtures::CenterlineIndex>(std::vector<fixtures::Vessel>{vesselOf(points)}, kUmPerPx);
  fixtures::CurveFixtureOptions options;
  options.compliance.lambda = lambda;
  // Shared by the closures of one task.
  const auto guide = std::make_shared<fixtures::VirtualFixtures>();
  guide->adopt(vessels, kMap);
  guide->assign({fixtures::CurveFixture(options)});
  const auto path = std::make_shared<const simulation::TracedPath>(std::move(points), kSpeed);
  LoopTask task;
  task.target = [path](double t_s) { return path->at(t_s); };
  task.fixture = [guide](const servo::Outlook& outlook) {
    const bool seen = outlook.reason == retina::Reason::none;
    return guide->evaluate({outlook.null_retina, Eigen::Isometry3d::Identity(), outlook.step_s, seen, kMap}).goal;
  };
  task.error = [vessels](const Eigen::Vector3d& tip, double) {
    const std::optional<fixtures::CurvePlace> nearest = vessels->nearest(tip.head<2>(), kFarthest);
    return nearest ? nearest->distance : kFarthest;
  };
  return task;
}

}  // namespace eyeslam::trials
