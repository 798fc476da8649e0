// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
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

  /// Names the columns in their order: visitor(name, member).
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor);
};

/// The columns' names, in their order.
const std::vector<std::string>& columns();
/// Their values as text, empty where they do not apply.
std::vector<std::string> rowOf(const TrialScore& score);
/// The score of such a row, but for `more`. @throws std::invalid_argument naming the column that cannot be read
TrialScore scoreOf(const std::vector<std::string>& row);
/// Every score as JSON text; null where it does not apply or is no finite number.
std::string jsonOf(const TrialScore& score);

template <class Self, class Visitor>
void TrialScore::visit(Self& self, Visitor&& visitor)
{
  visitor("scenario", self.scenario);
  visitor("seed", self.seed);
  visitor("aid", self.aid);
  visitor("motion", self.motion);
  visitor("condition", self.condition);
  visitor("retina", self.retina);
  visitor("camera_hz", self.camera_hz);
  visitor("latency_ms", self.latency_ms);
  visitor("mean_um", self.mean_um);
  visitor("rms_um", self.rms_um);
  visitor("median_um", self.median_um);
  visitor("p95_um", self.p95_um);
  visitor("max_um", self.max_um);
  visitor("path_coverage", self.path_coverage);
  visitor("duration_s", self.duration_s);
  visitor("tip_travel_mm", self.tip_travel_mm);
  visitor("saturated_fraction", self.saturated_fraction);
  visitor("pose_rms_px", self.pose_rms_px);
  visitor("pose_rms_deg", self.pose_rms_deg);
  visitor("tracked_fraction", self.tracked_fraction);
  visitor("targets", self.targets);
  visitor("fired", self.fired);
  visitor("refused", self.refused);
  visitor("missed", self.missed);
  visitor("placement_mean_um", self.placement_mean_um);
  visitor("placement_p95_um", self.placement_p95_um);
  visitor("placement_max_um", self.placement_max_um);
  visitor("far_pulses", self.far_pulses);
  visitor("far_unexplained", self.far_unexplained);
  visitor("burns_per_s", self.burns_per_s);
  visitor("min_vessel_clearance_um", self.min_vessel_clearance_um);
  visitor("interlock_violations", self.interlock_violations);
  visitor("hold_events", self.hold_events);
  visitor("fault_events", self.fault_events);
  visitor("wall_s", self.wall_s);
  visitor("version", self.version);
  visitor("config_hash", self.config_hash);
}

}  // namespace eyeslam::trials
