// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/options.h"

namespace eyeslam::simulation {

/// White reflections of the light on cornea and lens. Lengths in frame px of a view 800 px wide.
struct SpecularBloomsOptions {
  int count = 3;
  double smallest_px = 7.0;
  double largest_px = 20.0;
  double wander_px = 14.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("count", self.count, Range{0, 50}, "", "how many there are; source: rendered sequences, 1-4 in view");
    visitor.field("smallest_px", self.smallest_px, Range{1, 200}, "px",
                  "radius of the smallest white core; source: our choice, by eye");
    visitor.field("largest_px", self.largest_px, Range{1, 200}, "px",
                  "radius of the largest white core; source: our choice, by eye");
    visitor.field("wander_px", self.wander_px, Range{0, 200}, "px",
                  "how far they move: they follow the lens, not the retina; source: our choice");
  }
};

class SpecularBlooms {
 public:
  SpecularBlooms(const SpecularBloomsOptions& options, cv::Size view, double px_scale, double duration_s,
                 std::uint64_t seed);

  /// Adds their light at an instant to a picture (CV_32FC4, white = 1).
  void addTo(cv::Mat& picture, double t_s) const;
  /// Whether one may ever whiten what lies this near to a place of the view, px.
  bool mayHide(cv::Point2d place, double within_px) const;

 private:
  struct Bloom {
    cv::Point2d place;
    double radius, wander, phase_x, phase_y, hz, from_s, to_s;
  };

  std::vector<Bloom> blooms_;
};

/// Adds a white spot with a flat core of `radius` px and a glow around it, times `colour`.
void addGlow(cv::Mat& picture, cv::Point2d centre, double radius, const cv::Scalar& colour);

}  // namespace eyeslam::simulation
