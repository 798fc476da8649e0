// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "guidance/guided_tracing.h"

namespace eyeslam::apps {

/// How far tips (without an aid) or goals (with one) were off the vessel, over all milliseconds of all seeds.
struct TracingScore {
  double rms_um = 0.0;         ///< mean over seeds
  double rms_spread_um = 0.0;  ///< standard deviation over seeds
  double median_um = 0.0;
  double p95_um = 0.0;
  double in_force_max_um = 0.0;  ///< the largest while nothing is handed over and the retina is no faster than a goal
  double law_max_um = 0.0;       ///< largest difference from lambda x the filtered hand's distance, in force
  double left_behind = 0.0;      ///< share of the time in which the retina was faster than a goal may be
};

/// The loop study's vessel, another one each seed, traced for some time after 4 s to settle (loop study, section 1).
/// @param options  its seed is the first of `seeds`
TracingScore scoreTracing(const GuidedTracingOptions& options, std::uint64_t seeds, double seconds);

/// Where the fixture alone decides on the goal: nothing is handed over, and the goal keeps up with the retina.
bool inForce(const fixtures::FixtureOutput& fixture);

/// The study's vessel of a seed, retina frame, m, `height` above the retina.
std::vector<Eigen::Vector3d> studyPath(std::uint64_t seed, double height);

/// One vessel through points of the retina frame (m) as a graph would give it.
fixtures::Vessel vesselThrough(const std::vector<Eigen::Vector3d>& points, double um_per_px);

}  // namespace eyeslam::apps
