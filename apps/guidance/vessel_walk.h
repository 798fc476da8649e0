// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "eyeslam/fixtures/vessel_graph.h"

namespace eyeslam::apps {

/// A way along vessels and through junctions, without going back: its points, map frame, px.
///
///   const std::vector<Eigen::Vector2d> way = walk(graph.network(), vessel, 600.0, straightest);
using BranchChoice = std::function<std::size_t(const Eigen::Vector2d& heading, const std::vector<Eigen::Vector2d>&)>;

/// Begins at the first point of vessel `first` (a number of the list, no id) and goes on at each junction where
/// `choose` says, given the direction of travel and those of the branches (unit vectors, away from the junction; at
/// least one). Ends at a free end, at a vessel that it has been on, or after `longest_px`.
std::vector<Eigen::Vector2d> walk(const fixtures::VesselNetwork& network, std::size_t first, double longest_px,
                                  const BranchChoice& choose);

/// The branch that turns least.
std::size_t straightest(const Eigen::Vector2d& heading, const std::vector<Eigen::Vector2d>& branches);

/// Of all straightest ways within a circle a long one that is near its middle; empty where no vessel has two points in
/// it.
/// @param longest_px  no way is longer
std::vector<Eigen::Vector2d> longestWay(const fixtures::VesselNetwork& network, const Eigen::Vector2d& middle_px,
                                        double radius_px, double longest_px);

}  // namespace eyeslam::apps
