// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "eyeslam/retina/options.h"

namespace eyeslam::servo {

struct PlantInverseOptions {
  double plant_hz = 80.0;
  double plant_damping = 0.7;
  double response_hz = 160.0;
  double response_damping = 0.7;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("plant_hz", self.plant_hz, Range{1, 1000}, "Hz",
                  "natural frequency of the actuators; source: loop study, 1");
    visitor.field("plant_damping", self.plant_damping, Range{0.1, 5}, "", "of the actuators; source: loop study, 1");
    visitor.field("response_hz", self.response_hz, Range{0, 1000}, "Hz",
                  "that they are made to have, 0: left as they are; source: loop study, 4, bandwidth 160 Hz");
    visitor.field("response_damping", self.response_damping, Range{0.1, 5}, "", "that they are made to have");
  }
};

/// Makes a known second-order plant answer faster than it is: the deflection follows a quicker model of the plant, and
/// the command is what the plant needs to do that. Each millisecond of lead that this saves need not be predicted. A
/// filter of the command without feedback: a plant that is not as believed is followed less well, but never unstable.
/// SI. Never throws, never allocates.
class PlantInverse {
 public:
  /// @param period_s  for which each command is held
  explicit PlantInverse(const PlantInverseOptions& options, double period_s = 1e-3);

  /// The command that brings the plant to `deflection` after `lead()`.
  Eigen::Vector3d shape(const Eigen::Vector3d& deflection) noexcept;
  void standAt(const Eigen::Vector3d& deflection) noexcept;

  /// 2 z / w of the plant as it is, and as it is made to be; s.
  double plantLead() const noexcept { return plant_lead_; }
  double lead() const noexcept { return active_ ? response_lead_ : plant_lead_; }

 private:
  struct Step {
    Eigen::Matrix2d free;
    Eigen::Vector2d forced;
  };

  Step step(double time_s) const;

  bool active_;
  double plant_lead_, response_lead_;
  double plant_square_, response_square_;  // (rad/s)^2
  Step half_, whole_;
  Eigen::Matrix<double, 2, 3> state_ = Eigen::Matrix<double, 2, 3>::Zero();  // position, velocity; a column per axis
};

}  // namespace eyeslam::servo
