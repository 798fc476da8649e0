// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/simulation/shaped_noise.h"

namespace eyeslam::simulation {

/// How a surgeon steers by what he sees.
struct SurgeonOptions {
  double gain_hz = 1.8;
  double reaction_ms = 200.0;
  double dead_zone_um = 25.0;
  double lag_ms = 100.0;
  double patience_um = 600.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("gain_hz", self.gain_hz, Range{0, 20}, "1/s", "speed per distance seen; source: loop study, 1");
    visitor.field("reaction_ms", self.reaction_ms, Range{0, 2000}, "ms",
                  "age of what he reacts to; source: facts, C4: 150-250 ms");
    visitor.field("dead_zone_um", self.dead_zone_um, Range{0, 2000}, "um",
                  "distances up to this go uncorrected; source: loop study, 1; 150 um while a laser pattern is burnt");
    visitor.field("lag_ms", self.lag_ms, Range{0, 2000}, "ms",
                  "time constant of the arm behind the will; source: loop study, 1");
    visitor.field("patience_um", self.patience_um, Range{0, 5000}, "um",
                  "tip and null farther apart than this: he pulls back; source: loop study, 1");
  }
};

/// What the surgeon sees at an instant, in the world's frame; m, m/s.
struct SurgeonView {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();         ///< where the tip should be
  Eigen::Vector3d path_velocity = Eigen::Vector3d::Zero();  ///< of the target along its path, on the retina
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();            ///< what he steers: the tip, or the null for a pattern
  Eigen::Vector3d null = Eigen::Vector3d::Zero();           ///< where his hand carries the manipulator's null
};

/// A surgeon's will: hand velocity = gain x (target - tip as seen a reaction time ago, beyond a dead zone) + path
/// velocity, through a lag. When tip and null have drifted apart he pulls the null back to the tip. Tremor and drift
/// are not in it: `Hand` adds them. Source: loop study, section 1. Never allocates after construction.
class Surgeon {
 public:
  Surgeon(const SurgeonOptions& options, const Eigen::Vector3d& start, double period_s = 1e-3);

  /// One period later: where he means to hold the null, m.
  const Eigen::Vector3d& step(const SurgeonView& view);
  const Eigen::Vector3d& position() const { return position_; }

 private:
  Eigen::Vector3d wantedVelocity(const SurgeonView& seen) const;

  double gain_, dead_zone_, patience_, period_s_;
  double followed_;                // share of the wanted velocity's change that a period brings
  std::vector<SurgeonView> seen_;  // ring over the reaction time
  std::size_t oldest_ = 0;
  bool opened_ = false;  // his eyes: something has been seen
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d position_;
};

}  // namespace eyeslam::simulation
