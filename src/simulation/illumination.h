// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/simulation/random.h"

namespace eyeslam::simulation {

/// Light and field of view. Lengths in frame px of a view 800 px wide.
struct IlluminationOptions {
  double gain = 0.88;
  double cone_px = 330.0;
  double floor = 0.5;
  double wander_px = 60.0;
  double rim_radius_px = 440.0;
  double rim_softness_px = 37.0;
  double rim_offset_px = 14.0;
  int blackouts = 0;
  double blackout_shortest_s = 0.5;
  double blackout_longest_s = 1.5;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("gain", self.gain, Range{0.05, 4.0}, "",
                  "brightness of white under the full light; source: rendered sequences, red 140-180");
    visitor.field("cone_px", self.cone_px, Range{50, 10000}, "px",
                  "sigma of the light cone; source: our choice, by eye");
    visitor.field("floor", self.floor, Range{0, 1}, "of the cone's middle",
                  "light far from the cone; source: our choice, by eye");
    visitor.field("wander_px", self.wander_px, Range{0, 400}, "px", "how far the light pipe moves; source: our choice");
    visitor.field("rim_radius_px", self.rim_radius_px, Range{0, 10000}, "px",
                  "radius of the round field, 0 = no rim; source: rendered sequences, 397-444");
    visitor.field("rim_softness_px", self.rim_softness_px, Range{1, 200}, "px",
                  "width of the rim's edge; source: our choice, by eye");
    visitor.field("rim_offset_px", self.rim_offset_px, Range{0, 200}, "px",
                  "largest offset of the field from the image centre; source: our choice, by eye");
    visitor.field("blackouts", self.blackouts, Range{0, 100}, "", "how often the light goes out; source: our choice");
    visitor.field("blackout_shortest_s", self.blackout_shortest_s, Range{0.05, 100}, "s", "source: rendered sequences");
    visitor.field("blackout_longest_s", self.blackout_longest_s, Range{0.05, 100}, "s", "source: rendered sequences");
  }
};

/// What the light does to a view of fixed size.
class Illumination {
 public:
  struct Interval {
    double from_s, to_s;
  };

  Illumination(const IlluminationOptions& options, cv::Size view, double px_scale, double duration_s,
               std::uint64_t seed);

  /// Brightness of white per pixel at an instant, without the rim; CV_32F, of the view's size.
  void lightAt(double t_s, cv::Mat_<float>& light) const;
  /// 1 inside the field, 0 outside, soft between; CV_32F.
  const cv::Mat_<float>& field() const { return field_; }
  /// 0 while the light is out, 1 while it is on.
  double switchedOn(double t_s) const;
  /// When the light is out, in order.
  const std::vector<Interval>& darkIntervals() const { return dark_; }
  bool hasRim() const { return rim_radius_ > 0.0; }
  cv::Point2d rimCentre() const { return rim_centre_; }
  /// Where the field has fallen to half, px.
  double rimRadius() const { return rim_radius_; }

 private:
  void drawField(double softness_px);
  void planBlackouts(double duration_s, Random& random);

  IlluminationOptions options_;
  cv::Size view_;
  double px_scale_;
  double phase_x_ = 0.0;
  double phase_y_ = 0.0;
  cv::Point2d cone_centre_;
  cv::Point2d rim_centre_;
  double rim_radius_ = 0.0;
  cv::Mat_<float> field_;
  std::vector<Interval> dark_;
};

}  // namespace eyeslam::simulation
