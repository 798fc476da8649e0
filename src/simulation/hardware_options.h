// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/options.h"
#include "eyeslam/simulation/eye_camera_options.h"
#include "eyeslam/simulation/hand.h"
#include "eyeslam/simulation/laser_device.h"
#include "eyeslam/simulation/micron_controller_options.h"
#include "eyeslam/simulation/retina_motion_options.h"

namespace eyeslam::simulation {

/// How manipulator, eye and microscope stand to each other.
struct PlacementOptions {
  double yaw_deg = 25.0;
  double shaft_tilt_deg = 32.0;
  double shaft_azimuth_deg = -40.0;
  double port_mm = 20.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("yaw_deg", self.yaw_deg, Range{-180, 180}, "deg",
                  "of the manipulator's frame about its z, which points up; source: our choice, so that no frame is by "
                  "accident another");
    visitor.field("shaft_tilt_deg", self.shaft_tilt_deg, Range{1, 80}, "deg",
                  "between the shaft and the line of sight at the start; source: loop study, 1, axial motion acts by "
                  "tan 30 deg");
    visitor.field("shaft_azimuth_deg", self.shaft_azimuth_deg, Range{-180, 180}, "deg",
                  "of the port in the image, from x to y; source: our choice, above to the right");
    visitor.field("port_mm", self.port_mm, Range{5, 100}, "mm",
                  "from the tip up the shaft to the port at the start; source: facts, B1 and C5, RCM near the middle "
                  "of the shaft, globe of 11-12 mm radius");
  }
};

struct HardwareOptions {
  EyeCameraOptions camera;
  RetinaMotionOptions motion;
  HandOptions hand;
  MicronControllerOptions controller;
  LaserDeviceOptions laser;
  PlacementOptions placement;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    visitor.group("camera", self.camera);
    visitor.group("motion", self.motion);
    visitor.group("hand", self.hand);
    visitor.group("controller", self.controller);
    visitor.group("laser", self.laser);
    visitor.group("placement", self.placement);
  }
};

}  // namespace eyeslam::simulation
