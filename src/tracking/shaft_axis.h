// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "eyeslam/tracking/shaft_search.h"
#include "eyeslam/tracking/tint_sampler.h"

namespace eyeslam::tracking {

/// The instrument's axis in the image, full px, with what is known about it.
struct ShaftAxis {
  Eigen::Vector2d origin;     ///< a point on the axis near the tip
  Eigen::Vector2d direction;  ///< unit vector towards the tip
  double width = 0.0;         ///< of the shaft behind its taper
  double variance = 0.0;      ///< of the origin across the axis, px^2

  Eigen::Vector2d normal() const { return {-direction.y(), direction.x()}; }
  Eigen::Vector2d at(double along) const { return origin + along * direction; }
  Eigen::Vector2d at(double along, double across) const { return at(along) + across * normal(); }
};

/// Finds both edges of the shaft in cross sections and the line halfway between them.
class ShaftEdges {
 public:
  /// @param share  steel is where blue exceeds this share of the red (see Tint)
  /// @param bloom  from this blue on a bloom lies on the section, and it is left out
  ShaftEdges(double share, double bloom);

  /// @param rough  the axis so far; sections lie on its visible length
  /// @return the better axis, its origin where the rough one's is; nothing when too few sections show two edges
  std::optional<ShaftAxis> refine(const TintSampler& image, const ShaftAxis& rough, double length);

 private:
  struct Section {
    double along = 0.0;
    double middle = 0.0;
    double width = 0.0;
  };

  struct Trend {
    double offset = 0.0;
    double slope = 0.0;
    double sigma = 0.0;
    double at(double along) const { return offset + slope * along; }
  };

  void measure(const TintSampler& image, const ShaftAxis& rough, double length);
  double edge(const TintSampler& image, const Eigen::Vector2d& from, const Eigen::Vector2d& outwards,
              double farthest) const;
  double shaftWidth();
  Trend robustTrend();
  std::optional<ShaftAxis> fit(const ShaftAxis& rough, double width);

  float share_;
  float bloom_;
  std::vector<Section> sections_;
  std::vector<double> widths_, slopes_;
};

}  // namespace eyeslam::tracking
