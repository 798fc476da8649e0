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
  std::vector<Eigen::Vector2d>
      centreline;  ///< what is to be traced, and of what lies beyond both ends as much as a hand may lean
  std::size_t first = 0, count = 0;                  ///< of it, what is to be traced; count 0: nothing is wide enough
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< of its straight part
};

/// Straight on through junctions, cut where it turns sharply; beyond both ends as a fixture goes that keeps to the
/// vessel (fixtures::VesselRoute), for there a human means no other.
ChosenVessel vesselToTrace(const fixtures::VesselNetwork& network, const VesselWish& wish);

}  // namespace eyeslam::trials
