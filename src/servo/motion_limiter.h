// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "eyeslam/retina/options.h"

namespace eyeslam::servo {

struct MotionLimiterOptions {
  double speed_mm_s = 20.0;
  double acceleration_m_s2 = 8.0;
  double braking_m_s2 = 4.0;
  double arrival_mm_s = 0.5;
  double actuator_mm_s = 30.0;
  double reach_mm = 2.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("speed_mm_s", self.speed_mm_s, Range{0.1, 100}, "mm/s",
                  "of the goal; 10 under the actuator's, which cancelling tremor needs; source: loop study, 2.7");
    visitor.field("acceleration_m_s2", self.acceleration_m_s2, Range{0.1, 100}, "m/s^2",
                  "of the goal; source: under the 10 of the actuator, loop study, 1");
    visitor.field("braking_m_s2", self.braking_m_s2, Range{0.1, 100}, "m/s^2",
                  "with which the goal arrives where it is wanted; source: loop study, 2.7");
    visitor.field("arrival_mm_s", self.arrival_mm_s, Range{0.01, 10}, "mm/s",
                  "with which its last part is gone; source: loop study, 2.7");
    visitor.field("actuator_mm_s", self.actuator_mm_s, Range{0.1, 200}, "mm/s",
                  "of the deflection, tremor included; source: loop study, 1");
    visitor.field("reach_mm", self.reach_mm, Range{0.05, 10}, "mm",
                  "largest deflection; source: facts, B1: a cylinder of 4 mm");
  }
};

/// The last word on motion. Whatever comes in, NaN and infinity included:
///  - the goal's speed and acceleration stay within their limits, and it stops where it is wanted, within 2 %;
///  - the deflection stays within the reach, and changes no faster than the actuator can follow.
/// Nothing moves without a finite time step; a longer one than `kLongestStep_s` counts as that. Manipulator frame, m.
/// Source: loop study, section 2.7. Never throws, never allocates.
class MotionLimiter {
 public:
  static constexpr double kLongestStep_s = 5e-3;

  explicit MotionLimiter(const MotionLimiterOptions& options) noexcept;

  /// Goal and deflection stand here from now on; for a start, never within a motion. What is not finite is ignored.
  void standAt(const Eigen::Vector3d& goal, const Eigen::Vector3d& deflection = Eigen::Vector3d::Zero()) noexcept;
  /// One step towards what is wanted. Not finite: the goal brakes to a stand.
  const Eigen::Vector3d& goal(const Eigen::Vector3d& wanted, double time_s) noexcept;
  /// One step of the deflection towards what is wanted. Not finite: it stays.
  const Eigen::Vector3d& deflection(const Eigen::Vector3d& wanted, double time_s) noexcept;

  /// Shortened to the reach.
  Eigen::Vector3d withinReach(const Eigen::Vector3d& deflection) const noexcept;

  const Eigen::Vector3d& velocity() const noexcept { return velocity_; }
  /// The last deflection wanted lay beyond the reach.
  bool isSaturated() const noexcept { return saturated_; }

 private:
  double speed_, acceleration_, braking_, arrival_, actuator_, reach_;
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d deflection_ = Eigen::Vector3d::Zero();
  bool saturated_ = false;
};

}  // namespace eyeslam::servo
