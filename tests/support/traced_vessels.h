// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/fixtures/centerline_index.h"
#include "eyeslam/fixtures/vessel_graph.h"
#include "eyeslam/simulation/procedural_fundus.h"
#include "guidance/tracing_score.h"

namespace eyeslam::support {

/// Vessels to trace, and the scale of their map.
struct TracedVessels {
  fixtures::VesselNetwork network;
  double um_per_px = 5.0;

  std::shared_ptr<const fixtures::CenterlineIndex> index() const
  {
    return std::make_shared<const fixtures::CenterlineIndex>(network.vessels, um_per_px);
  }
};

/// The loop study's vessel (its section 1), another one each seed.
inline TracedVessels studyVessel(std::uint64_t seed)
{
  TracedVessels vessels;
  vessels.network.vessels.push_back(apps::vesselThrough(apps::studyPath(seed, 0.0), vessels.um_per_px));
  return vessels;
}

/// The graph of a map whose cells are certain: 255 or 0.
inline TracedVessels graphOf(const cv::Mat_<std::uint8_t>& mask, double um_per_px)
{
  retina::VesselMap map;
  map.width = mask.cols;
  map.height = mask.rows;
  map.um_per_px = um_per_px;
  map.probability.assign(mask.begin(), mask.end());
  fixtures::VesselGraph graph;
  graph.update(map);
  return {graph.network(), um_per_px};
}

/// The graph of a drawn retina's vessels from 8 px on: some hundred junctions.
inline TracedVessels drawnRetinaGraph(std::uint64_t seed)
{
  const simulation::Fundus fundus = simulation::proceduralFundus({}, seed);
  const cv::Mat_<std::uint8_t> mask(fundus.calibre_px >= 8.0);
  return graphOf(mask, fundus.um_per_px);
}

/// The graph of a photograph's manual mask; nothing when the photographs are not there.
inline std::optional<TracedVessels> photographGraph(const std::string& name)
{
  const char* shared = std::getenv("EYESLAM_SHARED");
  const cv::Mat_<std::uint8_t> mask = cv::imread(
      std::string(shared != nullptr ? shared : "") + "/photographs/" + name + "_vessels.png", cv::IMREAD_GRAYSCALE);
  if (mask.empty()) return std::nullopt;
  return graphOf(mask, 4.0);
}

/// Distance of a point (retina frame, m) from the polyline through a vessel's points, by trying every segment.
inline double distanceFrom(const fixtures::Vessel& vessel, double um_per_px, const Eigen::Vector2d& point)
{
  const Eigen::Vector2d at = point / (um_per_px * 1e-6);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < vessel.points.size(); ++i) {
    const Eigen::Vector2d& a = vessel.points[i - 1].position_px;
    const Eigen::Vector2d way = vessel.points[i].position_px - a;
    const double square = way.squaredNorm();
    const double part = square > 0.0 ? std::clamp((at - a).dot(way) / square, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (at - a - part * way).squaredNorm());
  }
  return std::sqrt(nearest) * um_per_px * 1e-6;
}

/// The same to all vessels.
inline double distanceFrom(const TracedVessels& vessels, const Eigen::Vector2d& point)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (const fixtures::Vessel& vessel : vessels.network.vessels) {
    nearest = std::min(nearest, distanceFrom(vessel, vessels.um_per_px, point));
  }
  return nearest;
}

}  // namespace eyeslam::support
