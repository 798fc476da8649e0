// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "eyeslam/retina/pose2.h"

namespace eyeslam::simulation {

/// What a renderer asks of whatever moves the retina. Two kinds run: `EyeMotion`, a function of time drawn from a seed,
/// and `RecordedView`, what the 1 kHz simulation of eye and hand has just done.
class ViewMotion {
 public:
  virtual ~ViewMotion() = default;

  /// The pose of the view at any instant of an exposure: map_T_frame in frame px (contracts, section 1).
  virtual retina::Pose2 at(double t_s) const = 0;
  /// Six coefficients (x^2, xy, y^2 of the map's x, then of its y; 1/px) of the warp that is added to the pose.
  virtual std::array<double, 6> warpAt(double t_s) const = 0;

 protected:
  ViewMotion() = default;
  ViewMotion(const ViewMotion&) = default;
  ViewMotion(ViewMotion&&) = default;
  ViewMotion& operator=(const ViewMotion&) = default;
  ViewMotion& operator=(ViewMotion&&) = default;
};

}  // namespace eyeslam::simulation
