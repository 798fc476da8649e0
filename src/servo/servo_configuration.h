// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/servo/calibration.h"
#include "eyeslam/servo/preparation.h"
#include "eyeslam/servo/servo_options.h"

namespace eyeslam::servo {

/// Every option of `eyeslam-servo`: the loop's own groups, and what is prepared beside it. As YAML it stands in the
/// program's MARK.
struct ServoConfiguration {
  ServoOptions servo;
  PreparationOptions preparation;
  CalibrationOptions calibration;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    ServoOptions::visit(self.servo, visitor);
    visitor.group("preparation", self.preparation);
    visitor.group("calibration", self.calibration);
  }
};

}  // namespace eyeslam::servo
