// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "eyeslam/fixtures/vessel_graph.h"

namespace eyeslam::support {

/// From a place to the nearest point of any centreline, px; the points are a px apart.
inline double distanceToCenterline(const Eigen::Vector2d& at, const std::vector<fixtures::Vessel>& vessels)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (const fixtures::Vessel& vessel : vessels) {
    for (std::size_t i = 1; i < vessel.points.size(); ++i) {
      const Eigen::Vector2d from = vessel.points[i - 1].position_px, step = vessel.points[i].position_px - from;
      const double length2 = step.squaredNorm();
      const double t = length2 > 0.0 ? std::clamp((at - from).dot(step) / length2, 0.0, 1.0) : 0.0;
      nearest = std::min(nearest, (from + t * step - at).norm());
    }
  }
  return nearest;
}

/// What holds for every graph, whatever the map.
inline void expectSound(const fixtures::VesselNetwork& network)
{
  const auto junction = [&network](int id) {
    return std::find_if(network.junctions.begin(), network.junctions.end(), [id](const auto& j) { return j.id == id; });
  };
  int last_id = -1;
  for (const fixtures::Vessel& vessel : network.vessels) {
    EXPECT_GT(vessel.id, last_id);
    last_id = vessel.id;
    ASSERT_GE(vessel.points.size(), 2U);
    EXPECT_EQ(vessel.points[0].s_px, 0.0);
    for (std::size_t i = 0; i < vessel.points.size(); ++i) {
      const fixtures::CenterlinePoint& point = vessel.points[i];
      ASSERT_TRUE(point.position_px.allFinite() && std::isfinite(point.radius_px) &&
                  std::isfinite(point.curvature_per_px));
      ASSERT_GT(point.radius_px, 0.0);
      ASSERT_NEAR(point.tangent.norm(), 1.0, 1e-9);
      if (i == 0) continue;
      const double step = (point.position_px - vessel.points[i - 1].position_px).norm();
      ASSERT_GT(step, 0.0);
      ASSERT_NEAR(point.s_px - vessel.points[i - 1].s_px, step, 1e-9);
    }
    const Eigen::Vector2d ends[] = {vessel.points.front().position_px, vessel.points.back().position_px};
    for (std::size_t end = 0; end < 2; ++end) {
      if (vessel.ends[end] == fixtures::Vessel::kNoJunction) continue;
      const auto at = junction(vessel.ends[end]);
      ASSERT_NE(at, network.junctions.end());
      ASSERT_LT((at->position_px - ends[end]).norm(), 1e-9) << "an end lies off its junction";
    }
  }
}

/// Equal lines, whatever their ids and the way they run.
inline void expectSameLines(const fixtures::VesselNetwork& a, const fixtures::VesselNetwork& b, double tolerance_px)
{
  ASSERT_EQ(a.vessels.size(), b.vessels.size());
  ASSERT_EQ(a.junctions.size(), b.junctions.size());
  for (const fixtures::Vessel& vessel : a.vessels) {
    const bool found = std::any_of(b.vessels.begin(), b.vessels.end(), [&](const fixtures::Vessel& other) {
      if (other.points.size() != vessel.points.size()) return false;
      const auto same = [&](const auto& x, const auto& y) {
        return (x.position_px - y.position_px).norm() <= tolerance_px &&
               std::abs(x.radius_px - y.radius_px) <= tolerance_px;
      };
      return std::equal(vessel.points.begin(), vessel.points.end(), other.points.begin(), same) ||
             std::equal(vessel.points.begin(), vessel.points.end(), other.points.rbegin(), same);
    });
    ASSERT_TRUE(found) << "vessel " << vessel.id << " has no equal";
  }
}

}  // namespace eyeslam::support
