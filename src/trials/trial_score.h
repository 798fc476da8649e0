// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace eyeslam::trials {

/// Everything that is said of one trial in numbers, a column of results.csv each (contracts, section 7), in their
/// order. Errors are against the simulation's truth. What does not apply is empty.
struct TrialScore {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string aid, motion, condition, retina;
  double camera_hz = 0.0, latency_ms = 0.0;

  std::optional<double> mean_um, rms_um, median_um, p95_um, max_um;  ///< of the tip; not of laser trials
  std::optional<double> path_coverage;                               ///< [0, 1]
  double duration_s = 0.0;                                           ///< that counts
  std::optional<double> tip_travel_mm;
  double saturated_fraction = 0.0;
  std::optional<double> pose_rms_px, pose_rms_deg;  ///< half-resolution px at the image's centre
  std::optional<double> tracked_fraction;

  std::optional<std::int64_t> targets, fired, refused, missed;
  std::optional<double> placement_mean_um, placement_p95_um, placement_max_um;
  std::optional<std::int64_t> far_pulses, far_unexplained;
  std::optional<double> burns_per_s;
  std::optional<double> min_vessel_clearance_um;  ///< true vessel's edge to a burn's edge; negative: they touch
  std::optional<std::int64_t> interlock_violations;

  std::int64_t hold_events = 0, fault_events = 0;
  double wall_s = 0.0;
  std::string version, config_hash;

  /// What no column has: name with unit, value; for results.json and the report.
  std::vector<std::pair<std::string, double>> more;
};

/// The columns' names, in their order.
const std::vector<std::string>& columns();
/// Their values as text, empty where they do not apply.
std::vector<std::string> rowOf(const TrialScore& score);
/// Every score as JSON text.
std::string jsonOf(const TrialScore& score);

}  // namespace eyeslam::trials
