// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/fixtures/tremor_filter.h"
#include "eyeslam/retina/options.h"
#include "eyeslam/servo/hand_over.h"
#include "eyeslam/servo/integral_action.h"
#include "eyeslam/servo/motion_limiter.h"
#include "eyeslam/servo/null_predictor.h"
#include "eyeslam/servo/plant_inverse.h"
#include "eyeslam/servo/registration_trim.h"
#include "eyeslam/servo/retina_predictor_options.h"

namespace eyeslam::servo {

struct ServoCycleOptions {
  std::string null_at = "servo";
  double lead_ms = 4.785;
  double state_limit_ms = 50.0;
  double pose_limit_ms = 250.0;
  bool predicts_null = true;
  bool trims = true;
  NullPredictorOptions hand;
  RetinaPredictorOptions retina;
  RegistrationTrimOptions trim;
  IntegralActionOptions integral;
  MotionLimiterOptions limits;
  PlantInverseOptions plant;
  fixtures::TremorFilterOptions hand_filter;
  HandOverOptions hand_over;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.choice("null_at", self.null_at, {"servo", "controller"},
                   "who subtracts the hand's null from the tip's goal; source: contracts, 7");
    visitor.field("lead_ms", self.lead_ms, Range{0, 100}, "ms",
                  "delay of the plant + 2 z / w, until the controller says it; source: loop study, 2");
    visitor.field("state_limit_ms", self.state_limit_ms, Range{1, 1000}, "ms",
                  "an older state serves no longer; source: contracts, 4");
    visitor.field("pose_limit_ms", self.pose_limit_ms, Range{1, 1000}, "ms",
                  "an older pose serves no longer; source: contracts, 4");
    visitor.field("predicts_null", self.predicts_null, Range{0, 1}, "",
                  "whether the null is predicted; without, 41 um instead of 16.5; source: loop study, 4");
    visitor.field("trims", self.trims, Range{0, 1}, "",
                  "whether the registration is trimmed; without, 38 um instead of 16.5; source: loop study, 4");
    visitor.group("hand", self.hand);
    visitor.group("retina", self.retina);
    visitor.group("trim", self.trim);
    visitor.group("integral", self.integral);
    visitor.group("limits", self.limits);
    visitor.group("plant", self.plant);
    visitor.group("hand_filter", self.hand_filter);
    visitor.group("hand_over", self.hand_over);
  }
};

}  // namespace eyeslam::servo
