// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "eyeslam/retina/options.h"

namespace eyeslam::simulation {

/// Calibres and branching of the retinal vessels.
struct VesselTreeOptions {
  double vein_um = 140.0;
  double artery_um = 118.0;
  double thinnest_um = 11.0;
  double branch_distance_um = 750.0;
  double tortuosity = 0.095;
  double spacing_um = 90.0;
  double avascular_um = 260.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("vein_um", self.vein_um, Range{20, 400}, "um",
                  "calibre of the largest veins at the disc; source: facts, 120-200 um");
    visitor.field("artery_um", self.artery_um, Range{20, 400}, "um",
                  "calibre of the largest arteries at the disc; source: anatomy, 90 to 120 um at the disc");
    visitor.field("thinnest_um", self.thinnest_um, Range{4, 100}, "um",
                  "vessels end at this calibre; source: anatomy, capillaries have 5 to 10 um");
    visitor.field("branch_distance_um", self.branch_distance_um, Range{50, 5000}, "um",
                  "mean length between two branchings; source: our choice, by eye");
    visitor.field("tortuosity", self.tortuosity, Range{0, 0.5}, "rad per step of 30 um",
                  "how strongly vessels wind; source: our choice, by eye");
    visitor.field("spacing_um", self.spacing_um, Range{20, 1000}, "um",
                  "vessels of one kind stay so far apart; source: our choice, by eye");
    visitor.field(
        "avascular_um", self.avascular_um, Range{0, 2000}, "um",
        "radius of the zone around the fovea without vessels; source: anatomy, the zone is 0.4 to 0.6 mm wide");
  }
};

/// Where things lie on a retina, um; x from left to right, y downwards.
struct RetinaPlan {
  Eigen::Vector2d extent;  ///< width and height
  Eigen::Vector2d disc;
  Eigen::Vector2d fovea;
  double disc_radius = 880.0;
};

struct VesselNode {
  Eigen::Vector2d place;  ///< um
  double radius;          ///< um
};

/// One vessel from its origin to where it ends or divides; the nodes are some 30 um apart.
struct Vessel {
  enum class Kind { artery, vein };
  Kind kind = Kind::artery;
  std::vector<VesselNode> nodes;
};

/// Grows arteries and veins out of the disc: four arcades of each around fovea and nasal side, branches by Murray's law
/// (r0^3 = r1^3 + r2^3, and his angles; Murray 1926), winding, tapering, crossing the other kind but not their own.
std::vector<Vessel> growVessels(const RetinaPlan& plan, const VesselTreeOptions& options, std::uint64_t seed);

}  // namespace eyeslam::simulation
