// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/configuration/assignment.h"
#include "eyeslam/fixtures/burn_prescription.h"
#include "eyeslam/retina/options.h"
#include "eyeslam/servo/calibration.h"
#include "eyeslam/servo/preparation.h"
#include "eyeslam/servo/servo_options.h"
#include "eyeslam/simulation/hardware_options.h"
#include "eyeslam/trials/lock_step_vision.h"

namespace eyeslam::trials {

/// What goes wrong in a trial, and what must then happen.
struct ScenarioFaultOptions {
  std::string kind = "none";
  double at_s = 5.0;
  double for_s = 2.0;
  std::string must = "go_on";
  std::string reason;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.choice(
        "kind", self.kind,
        {"none", "blackout", "tool_over_everything", "operator_lost", "states_stop", "tip_not_finite", "restart",
         "clock_step", "power_off", "laser_silent", "interlock_open", "camera_stops", "camera_freezes", "motion"},
        "what goes wrong; motion: nothing but how the eye moves; source: issues 16 and 17");
    visitor.field("at_s", self.at_s, Range{0, 3600}, "s", "after what counts began; source: our choice");
    visitor.field("for_s", self.for_s, Range{0, 3600}, "s", "how long; source: our choice");
    visitor.choice(
        "must", self.must, {"go_on", "hold", "fault"},
        "state that the servo must reach within 0.5 s, and no worse; go_on: none but the wanted one; source: "
        "contracts, 4");
    visitor.field("reason", self.reason, Range{0, 0}, "", "word that it must give; empty: any; source: contracts, 4");
  }
};

/// The laser's part of a scenario, besides the prescription.
struct LaserTaskOptions {
  double map_s = 8.0;
  double manual_gain_hz = 2.6;
  double manual_within_um = 100.0;
  double manual_delay_ms = 30.0;
  double rest_um = 150.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("map_s", self.map_s, Range{0, 600}, "s",
                  "age of the map when it is planned on; source: vessels complete after 6 s, results");
    visitor.field("manual_gain_hz", self.manual_gain_hz, Range{0, 20}, "1/s",
                  "of the manual operator, who hurries to the next target; source: loop study, 1");
    visitor.field("manual_within_um", self.manual_within_um, Range{1, 2000}, "um",
                  "he fires when the error that he saw was less; source: loop study, 1");
    visitor.field("manual_delay_ms", self.manual_delay_ms, Range{0, 1000}, "ms",
                  "from that decision to the pulse; source: loop study, 1");
    visitor.field("rest_um", self.rest_um, Range{0, 2000}, "um",
                  "the hand over an automated pattern corrects nothing smaller; source: loop study, 1");
  }
};

/// The experiment in the words of a lab (contracts, section 7): what a scenario file says first.
struct Scenario {
  std::string name = "trial";  ///< of the file; no key
  std::string task = "trace";
  std::string aid = "hard";
  double lambda = 0.1;
  std::string motion = "in_situ";
  std::string condition = "in_vivo";
  std::string null_at = "servo";
  std::string retina = "procedural";
  double retina_um_per_px = 4.0;
  double camera_hz = 30.0;
  double latency_ms = 20.0;
  double duration_s = 20.0;
  double settling_s = 4.0;
  double speed_mm_s = 0.4;
  double length_mm = 2.0;
  double standoff_um = 300.0;
  LaserTaskOptions laser;
  ScenarioFaultOptions fault;

  bool isManual() const { return aid == "none" || aid == "manual"; }
  bool isLaser() const { return task == "laser"; }

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    visitTask(self, visitor);
    visitConditions(self, visitor);
    visitor.group("laser", self.laser);
    visitor.group("fault", self.fault);
  }

 private:
  template <class Self, class Visitor>
  static void visitTask(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.choice("task", self.task, {"trace", "hold", "laser", "standoff"},
                   "what the surgeon is about; source: issue 17");
    visitor.choice("aid", self.aid, {"none", "filter", "scaling", "soft", "hard", "manual", "automated"},
                   "what helps; manual and automated are the laser's; source: contracts, 7");
    visitor.field("lambda", self.lambda, Range{0, 1}, "",
                  "share of the hand's departure that a soft fixture lets pass; source: loop study, 4");
    visitor.field("duration_s", self.duration_s, Range{0.5, 3600}, "s",
                  "that counts; of a laser task at most; source: loop study");
    visitor.field("settling_s", self.settling_s, Range{0, 60}, "s",
                  "before anything counts, once the aid is on; source: loop study");
    visitor.field("speed_mm_s", self.speed_mm_s, Range{0, 5}, "mm/s", "along the path; source: loop study, 1");
    visitor.field("length_mm", self.length_mm, Range{0.2, 10}, "mm",
                  "longest path, back and forth; source: our choice, within the reach of 2 mm");
    visitor.field("standoff_um", self.standoff_um, Range{50, 5000}, "um",
                  "height of the tip above the retina; source: our choice, the tip touches nothing");
  }

  template <class Self, class Visitor>
  static void visitConditions(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.choice("motion", self.motion, {"paper", "in_situ", "jerky", "saccade"},
                   "how the eye moves; source: loop study, 1");
    visitor.choice("condition", self.condition, {"paper", "ex_vivo", "in_vivo"}, "how it looks; source: contracts, 7");
    visitor.choice("null_at", self.null_at, {"servo", "controller"},
                   "who subtracts the hand's null; source: loop study, 3");
    visitor.field("retina", self.retina, Range{0, 0}, "",
                  "'procedural', or a photograph; its vessels' mask is beside it, NAME_vessels.png");
    visitor.field("retina_um_per_px", self.retina_um_per_px, Range{0.1, 100}, "um",
                  "width of the photograph's pixel; source: HRF, 45 degrees over 3262 px");
    visitor.field("camera_hz", self.camera_hz, Range{5, 500}, "1/s",
                  "frames a second; above 60 they are half as wide and high; source: loop study, 1");
    visitor.field("latency_ms", self.latency_ms, Range{0, 500}, "ms",
                  "longest from mid-exposure to the pose; the shortest is 0.7 of it; source: loop study, 1");
  }
};

/// All that decides on a trial but its seed: the scenario, and every option of every part, preset by it. Keys of both
/// stand side by side in files and on the command line.
struct TrialSetting {
  Scenario scenario;
  simulation::HardwareOptions hardware;
  LockStepVisionOptions vision;
  servo::ServoOptions servo;
  servo::PreparationOptions preparation;
  servo::CalibrationOptions calibration;
  fixtures::BurnPrescription prescription;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    Scenario::visit(self.scenario, visitor);
    visitor.group("hardware", self.hardware);
    visitor.group("vision", self.vision);
    visitor.group("servo", self.servo);
    visitor.group("preparation", self.preparation);
    visitor.group("calibration", self.calibration);
    visitor.group("prescription", self.prescription);
  }
};

/// The parts' options as the scenario wants them.
TrialSetting presetBy(const Scenario& scenario);

/// What a plan is asked for, about this place where the prescription leaves its centre open. @param middle_px  map px
fixtures::BurnPrescription prescriptionAbout(const TrialSetting& setting, const Eigen::Vector2d& middle_px);

/// A setting and the swept values that make it this one.
struct Variant {
  std::string name;  ///< "aid=hard", several joined by commas; empty where nothing is swept
  TrialSetting setting;
};

/// Reads a scenario file and applies the command line's settings over it. A value that is a list is swept: all
/// combinations, the first list slowest.
/// @throws configuration::ConfigurationError naming file, line and key: unknown, out of range, or at odds with the rest
std::vector<Variant> readScenario(const std::string& path, const std::vector<configuration::Assignment>& settings);

/// The setting that a log's MARK tells, from the YAML that `configuration::yamlOf` wrote.
/// @throws configuration::ConfigurationError
TrialSetting settingOf(const std::string& name, const std::string& yaml);

}  // namespace eyeslam::trials
