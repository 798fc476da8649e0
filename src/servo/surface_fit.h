// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "eyeslam/servo/camera_registration.h"

namespace eyeslam::servo {

struct SurfaceFitOptions {
  double least_points = 12.0;
  double most_points = 500.0;
  double worst_residual_um = 60.0;
  double least_extent_um = 300.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("least_points", self.least_points, Range{3.0, 500.0}, "",
                  "fewer do not serve; source: four unknowns");
    visitor.field("most_points", self.most_points, Range{3.0, 1e5}, "",
                  "of more, evenly chosen ones are used; source: issue of the servo loop");
    visitor.field("worst_residual_um", self.worst_residual_um, Range{1.0, 1000.0}, "um",
                  "RMS beyond it is no plane; source: the retina bends 45 um within 1 mm (globe of 11 mm, facts C5)");
    visitor.field("least_extent_um", self.least_extent_um, Range{1.0, 10000.0}, "um",
                  "standard deviation across the narrower direction of the sweep; source: 60 um / 300 um is 11 deg");
  }
};

struct SurfaceFit {
  RetinaPlane plane;
  int used = 0;                                             ///< points that the fit explains
  retina::Reason reason = retina::Reason::surface_unknown;  ///< none when good
};

/// The retina as a plane through points that the aiming beam or the tip swept (facts E3), robustly: up to a third of
/// the points may be wrong. Manipulator frame, m. Allocates; not for the loop.
/// @param towards  any point on the instrument's side: decides which way the normal points
SurfaceFit fitSurface(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& towards,
                      const SurfaceFitOptions& options = {});

}  // namespace eyeslam::servo
