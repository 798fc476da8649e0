// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <vector>

#include "eyeslam/fixtures/vessel_graph.h"

namespace eyeslam::trials {

/// The vessel that a surgeon would choose to trace: long, wide enough to see, smooth and apart from others. Map frame,
/// full-resolution px.
struct VesselWish {
  Eigen::AlignedBox2d area_px;                           ///< in which it is looked for
  double longest_px = 0.0;                               ///< no longer a way
  double radius_px = 0.0;                                ///< median of a vessel that is wide enough
  double apart_px = 0.0;                                 ///< nearer to another vessel than this is crowded
  std::function<bool(const Eigen::Vector2d&)> excluded;  ///< places that it keeps away from; none: nowhere
  double beyond_px = 0.0;  ///< for so far the vessel must go on beyond both ends, uncrossed by a wider one
  double um_per_px = 1.0;
};

/// A stretch of a vessel.
struct ChosenVessel {
  std::vector<Eigen::Vector2d> centreline;  ///< what is to be traced; empty: nothing is wide enough
  std::vector<Eigen::Vector2d> leaned_on;   ///< the same and what it goes on into, as far as is wished for and is there
  std::size_t clear_at = 0;                 ///< of the centreline, farthest from all others: there one points at it
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< of its straight part
};

/// A vessel as a fixture goes that keeps to it (fixtures::VesselRoute), for a human means no other; cut where it turns
/// sharply.
ChosenVessel vesselToTrace(const fixtures::VesselNetwork& network, const VesselWish& wish);

}  // namespace eyeslam::trials
