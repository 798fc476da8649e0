// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/options.h"
#include "eyeslam/servo/burn_run_options.h"
#include "eyeslam/servo/calibration.h"
#include "eyeslam/servo/guidance.h"
#include "eyeslam/servo/health_monitor.h"
#include "eyeslam/servo/pivot_estimator.h"
#include "eyeslam/servo/registration_desk.h"
#include "eyeslam/servo/servo_cycle_options.h"

namespace eyeslam::servo {

struct ServoOptions {
  double image_width_px = 800.0;
  double image_height_px = 608.0;
  double largest_jump_um = 1500.0;
  double command_expiry_ms = 50.0;
  double speed_bound_mm_s = 30.0;
  double status_hz = 50.0;
  bool keeps_pivot = true;
  ServoCycleOptions cycle;
  HealthMonitorOptions health;
  GuidanceOptions guidance;
  PivotEstimatorOptions pivot;
  RegistrationDeskOptions registration;
  CalibrationPatternOptions sweep;
  BurnRunOptions burning;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("image_width_px", self.image_width_px, Range{16, 10000}, "full-resolution px",
                  "of the camera; a pose turns about the image's centre; source: contracts, 1");
    visitor.field("image_height_px", self.image_height_px, Range{16, 10000}, "full-resolution px",
                  "see image_width_px");
    visitor.field(
        "largest_jump_um", self.largest_jump_um, Range{50, 10000}, "um",
        "a pose farther from where it was expected is not believed; source: a saccade has 1.3 mm, loop study, 1");
    visitor.field("command_expiry_ms", self.command_expiry_ms, Range{1, 1000}, "ms",
                  "after which the controller obeys a command no longer; source: contracts, 4");
    visitor.field("speed_bound_mm_s", self.speed_bound_mm_s, Range{0.1, 200}, "mm/s",
                  "of the tip, whatever the goal; source: limit of the actuators, loop study, 1");
    visitor.field("status_hz", self.status_hz, Range{1, 1000}, "Hz", "of SERVO_STATUS; source: contracts, 4");
    visitor.field("keeps_pivot", self.keeps_pivot, Range{0, 1}, "",
                  "whether the shaft is kept in the port, where that is known; source: facts B2");
    visitor.group("cycle", self.cycle);
    visitor.group("health", self.health);
    visitor.group("guidance", self.guidance);
    visitor.group("pivot", self.pivot);
    visitor.group("registration", self.registration);
    visitor.group("sweep", self.sweep);
    visitor.group("burning", self.burning);
  }
};

}  // namespace eyeslam::servo
