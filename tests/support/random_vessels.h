// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "eyeslam/fixtures/vessel.h"

namespace eyeslam::support {

/// Vessels with the junctions that they meet in.
struct RandomVessels {
  std::vector<fixtures::Vessel> vessels;
  std::vector<fixtures::Junction> junctions;
};

/// Fills in arc length, tangent and curvature of a vessel from its positions.
inline void measure(fixtures::Vessel& vessel)
{
  std::vector<fixtures::CenterlinePoint>& points = vessel.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, points.size() - 1);
    points[i].s_px = i > 0 ? points[i - 1].s_px + (points[i].position_px - points[i - 1].position_px).norm() : 0.0;
    points[i].tangent = (points[after].position_px - points[before].position_px).normalized();
    if (i == 0 || i + 1 == points.size()) continue;
    const Eigen::Vector2d in = points[i].position_px - points[before].position_px;
    const Eigen::Vector2d out = points[after].position_px - points[i].position_px;
    const double turn = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
    points[i].curvature_per_px = turn / (0.5 * (in.norm() + out.norm()));
  }
}

/// Trees of vessels over a square of the map, full-resolution px: smooth, a point every px, no bend tighter than 20 px,
/// branching at 20 to 60 degrees, calibre 6 to 24 px, shrinking from trunk to twig. Vessels of different trees cross
/// without a junction. Repeatable per seed.
class VesselGrower {
 public:
  VesselGrower(std::mt19937& random, double side_px) : random_(random), side_px_(side_px) {}

  RandomVessels grow(int trees)
  {
    for (int tree = 0; tree < trees; ++tree) {
      const Eigen::Vector2d root(uniform(-0.4, 0.4) * side_px_, uniform(-0.4, 0.4) * side_px_);
      branch(root, uniform(-M_PI, M_PI), uniform(5.0, 12.0), fixtures::Vessel::kNoJunction, 3);
    }
    return grown_;
  }

 private:
  double uniform(double lowest, double highest) { return lowest + (highest - lowest) * unit_(random_); }

  void branch(Eigen::Vector2d at, double direction, double radius_px, int from, int generations)
  {
    const double length = uniform(80.0, 350.0);
    double turning = 0.0;
    std::vector<fixtures::CenterlinePoint> points;
    for (double s = 0.0; s < length && at.cwiseAbs().maxCoeff() < 0.5 * side_px_; s += 1.0) {
      points.push_back({at, Eigen::Vector2d::UnitX(), radius_px, 0.0, 0.0});
      turning = std::clamp(0.97 * turning + uniform(-0.006, 0.006), -0.05, 0.05);
      direction += turning;
      at += Eigen::Vector2d(std::cos(direction), std::sin(direction));
    }
    if (points.size() < 20) return;
    fixtures::Vessel vessel;
    vessel.id = next_id_++;
    vessel.points = std::move(points);
    vessel.ends[0] = from;
    measure(vessel);
    const Eigen::Vector2d tip = vessel.points.back().position_px;
    const bool ends = generations == 0 || uniform(0.0, 1.0) < 0.15;
    if (!ends) {
      vessel.ends[1] = static_cast<int>(grown_.junctions.size()) + 1000;
      grown_.junctions.push_back({vessel.ends[1], tip});
    }
    const int junction = vessel.ends[1];
    grown_.vessels.push_back(std::move(vessel));
    if (ends) return;
    branch(tip, direction + uniform(0.35, 1.0), radius_px * 0.8, junction, generations - 1);
    branch(tip, direction - uniform(0.35, 1.0), radius_px * 0.8, junction, generations - 1);
  }

  std::mt19937& random_;
  double side_px_;
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
  RandomVessels grown_;
  int next_id_ = 1;
};

inline RandomVessels randomVesselGraph(std::mt19937& random, int trees, double side_px)
{
  return VesselGrower(random, side_px).grow(trees);
}

/// The same vessels in a newer map: displaced smoothly by up to `most_px`, each missing with a probability.
inline RandomVessels updatedVessels(const RandomVessels& old, std::mt19937& random, double most_px, double missing)
{
  std::uniform_real_distribution<double> phase(0.0, 2.0 * M_PI), share(0.0, 1.0);
  const double a = phase(random), b = phase(random);
  const auto moved = [&](const Eigen::Vector2d& at) {
    return Eigen::Vector2d(at + most_px * M_SQRT1_2 *
                                    Eigen::Vector2d(std::sin(a + at.y() / 80.0), std::sin(b + at.x() / 80.0)));
  };
  RandomVessels updated;
  for (fixtures::Vessel vessel : old.vessels) {
    if (share(random) < missing) continue;
    for (fixtures::CenterlinePoint& point : vessel.points) point.position_px = moved(point.position_px);
    measure(vessel);
    updated.vessels.push_back(std::move(vessel));
  }
  updated.junctions = old.junctions;
  for (fixtures::Junction& junction : updated.junctions) junction.position_px = moved(junction.position_px);
  return updated;
}

/// A vessel through these points, straight between them, a point every px or so.
inline fixtures::Vessel vesselThrough(int id, const std::vector<Eigen::Vector2d>& corners, std::array<int, 2> ends,
                                      double radius_px = 6.0)
{
  fixtures::Vessel vessel;
  vessel.id = id;
  vessel.ends = ends;
  vessel.points.push_back({corners.front(), Eigen::Vector2d::UnitX(), radius_px, 0.0, 0.0});
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Eigen::Vector2d way = corners[i] - corners[i - 1];
    const int pieces = std::max(1, static_cast<int>(std::lround(way.norm())));
    for (int k = 1; k <= pieces; ++k)
      vessel.points.push_back(
          {corners[i - 1] + way * (static_cast<double>(k) / pieces), Eigen::Vector2d::UnitX(), radius_px, 0.0, 0.0});
  }
  measure(vessel);
  return vessel;
}

}  // namespace eyeslam::support
