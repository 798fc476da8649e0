// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "eyeslam/retina/options.h"

namespace eyeslam::servo {

/// Source: loop study, section 2.6.
struct IntegralActionOptions {
  double rate_per_s = 20.0;
  double freeze_um = 60.0;
  double limit_um = 150.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field(
        "rate_per_s", self.rate_per_s, Range{0, 200}, "1/s",
        "share of the error that is added each second; 0: none; unstable from 350; source: loop study, 2.6, 4");
    visitor.field("freeze_um", self.freeze_um, Range{0, 5000}, "um",
                  "larger errors are motion on the way, not a fault of the plant; source: loop study, 2.6");
    visitor.field("limit_um", self.limit_um, Range{0, 2000}, "um", "largest correction; source: loop study, 2.6");
  }
};

/// Takes away what the manipulator does wrong by itself: gain errors, sag. Fed by the measured tip, not by the image,
/// so a late camera cannot make it swing; frozen where the error is large or the reach is at its end. Manipulator
/// frame, m. Never throws, never allocates.
class IntegralAction {
 public:
  explicit IntegralAction(const IntegralActionOptions& options) noexcept;

  /// @param error  goal of the instant at which the tip was measured, minus that tip; anything not finite changes
  /// nothing
  void update(const Eigen::Vector3d& error, double time_s) noexcept;
  void reset() noexcept { correction_.setZero(); }
  const Eigen::Vector3d& correction() const noexcept { return correction_; }

 private:
  double rate_, freeze_, limit_;
  Eigen::Vector3d correction_ = Eigen::Vector3d::Zero();
};

}  // namespace eyeslam::servo
