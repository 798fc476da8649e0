// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/servo/unknown.h"

namespace eyeslam::servo {

struct LaserInterlocksOptions {
  double laser_age_ms = 50.0;
  double operator_age_ms = 200.0;
  double latency_ms = 20.0;
  double frame_ms = 33.4;
  double oldest_pose_ms = 60.0;
  double pose_error_um = 20.0;
  double innovation_um = 20.0;
  double innovation_in_pulse_um = 40.0;
  double rest_after_jump_ms = 150.0;
  double settled_um = 20.0;
  double settled_ms = 30.0;
  double spot_um = 40.0;
  double reach_left_um = 200.0;
  double speed_mm_s = 2.0;
  double retina_speed_mm_s = 5.0;
  double standoff_um = 300.0;
  double clearance_um = 100.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("laser_age_ms", self.laser_age_ms, Range{1, 50}, "ms", "oldest LASER_STATE; source: contracts 4");
    visitor.field("operator_age_ms", self.operator_age_ms, Range{1, 200}, "ms", "oldest OPERATOR; source: contracts 4");
    visitor.field("latency_ms", self.latency_ms, Range{0, 60}, "ms",
                  "from mid-exposure to the pose; source: loop study 1, 14 to 20 ms");
    visitor.field("frame_ms", self.frame_ms, Range{1, 60}, "ms", "period of the camera; source: 30 Hz");
    visitor.field("oldest_pose_ms", self.oldest_pose_ms, Range{1, 60}, "ms",
                  "oldest pose, whatever latency and frame say; source: contracts 4");
    visitor.field("pose_error_um", self.pose_error_um, Range{1, 200}, "um",
                  "largest 95 % error of the pose at the target; source: the margin of a plan holds it");
    visitor.field("innovation_um", self.innovation_um, Range{1, 500}, "um",
                  "largest surprise of the newest pose before a pulse; source: loop study 2.8");
    visitor.field("innovation_in_pulse_um", self.innovation_in_pulse_um, Range{1, 500}, "um",
                  "and within one; source: loop study 2.8");
    visitor.field("rest_after_jump_ms", self.rest_after_jump_ms, Range{0, 5000}, "ms",
                  "quiet since the last jump of the retina; source: loop study 2.8");
    visitor.field("settled_um", self.settled_um, Range{1, 200}, "um",
                  "tip to its goal, mean of 5 ms; source: loop study 2.8, less only waits longer");
    visitor.field("settled_ms", self.settled_ms, Range{0, 1000}, "ms", "for so long; source: loop study 2.8");
    visitor.field("spot_um", self.spot_um, Range{1, 500}, "um",
                  "aiming spot to target in the newest frame; source: loop study 2.8");
    visitor.field("reach_left_um", self.reach_left_um, Range{0, 2000}, "um",
                  "deflection left to the end of the reach; source: loop study 5, all far pulses had less");
    visitor.field("speed_mm_s", self.speed_mm_s, Range{0.1, 20}, "mm/s",
                  "of the tip on the retina; source: loop study 2.8");
    visitor.field("retina_speed_mm_s", self.retina_speed_mm_s, Range{0.1, 50}, "mm/s",
                  "of the retina; source: smooth motion is 0.3 to 0.8 mm/s RMS, loop study 1");
    visitor.field("standoff_um", self.standoff_um, Range{1, 5000}, "um",
                  "height over the retina to the planned one; source: burn size follows the distance, facts D1");
    visitor.field("clearance_um", self.clearance_um, Range{0, 5000}, "um",
                  "edge of the burn to the nearest vessel, in the newest map; source: facts D1, 100 um");
  }
};

/// What a pulse depends on, judged in this very cycle. Everything starts as what forbids it.
struct PulseConditions {
  bool laser_state = false;          ///< the supervisor is in Laser
  bool foot_switch = false;          ///< pressed
  bool armed_by_human = false;       ///< OPERATOR says so
  bool armed_laser = false;          ///< the laser's own controls say so
  bool interlock_closed = false;     ///< the remote interlock
  bool plan_in_force = false;        ///< approved by hash, unchanged
  bool target_valid = false;         ///< against the newest map
  bool target_unburnt = false;       ///< one pulse a target
  bool registered = false;           ///< the camera is registered well enough
  bool tracked = false;              ///< the newest frame was localized
  double laser_age = kUnknown;       ///< s since LASER_STATE was received
  double operator_age = kUnknown;    ///< s since OPERATOR was received
  double pose_age = kUnknown;        ///< s since the middle of the newest pose's exposure
  double pose_error = kUnknown;      ///< m, 95 % error of the pose at the target
  double innovation = kUnknown;      ///< m, of the newest pose
  double since_jump = 0.0;           ///< s
  double goal_distance = kUnknown;   ///< m, tip to goal, mean of 5 ms
  double settled_for = 0.0;          ///< s with that below the limit
  double spot_distance = kUnknown;   ///< m, aiming spot to target in the newest frame
  double reach_left = 0.0;           ///< m
  double speed = kUnknown;           ///< m/s, of the tip on the retina
  double retina_speed = kUnknown;    ///< m/s
  double standoff_error = kUnknown;  ///< m
  double clearance = 0.0;            ///< m, edge of the burn to the nearest vessel
};

/// Whether a pulse may begin or go on: only while every interlock is closed. What is not a number counts as open.
/// This is not the safety system: the laser's own hardware is (facts D2). Never throws, never allocates.
class LaserInterlocks {
 public:
  explicit LaserInterlocks(const LaserInterlocksOptions& options = {}) : options_(options) {}

  /// The first interlock that is open; none = a pulse may begin.
  retina::Reason whyNotBegin(const PulseConditions& now) const;
  /// The first one that a running pulse must not outlast; none = it may go on.
  retina::Reason whyNotGoOn(const PulseConditions& now) const;

 private:
  LaserInterlocksOptions options_;
};

}  // namespace eyeslam::servo
