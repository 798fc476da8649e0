// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/simulation/random.h"

namespace eyeslam::simulation {

/// A tapered metal shaft over the retina. Lengths in frame px of a view 800 px wide.
struct InstrumentOptions {
  double present_fraction = 0.5;
  double narrowest_px = 26.0;
  double widest_px = 40.0;
  double taper_widths = 3.4;
  double wander_px = 90.0;
  double softness_px = 2.0;
  double shadow_depth = 0.42;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("present_fraction", self.present_fraction, Range{0, 1}, "of the time",
                  "how long the instrument is in view, 0 = never; source: our choice");
    visitor.field("narrowest_px", self.narrowest_px, Range{1, 400}, "px",
                  "smallest shaft width; source: rendered sequences, 26-40 in vivo, 66 ex vivo");
    visitor.field("widest_px", self.widest_px, Range{1, 400}, "px", "largest shaft width; source: our choice, by eye");
    visitor.field("taper_widths", self.taper_widths, Range{0.5, 20}, "shaft widths",
                  "length of the tapered end; source: rendered sequences");
    visitor.field("wander_px", self.wander_px, Range{0, 400}, "px", "how far the tip moves about; source: our choice");
    visitor.field("softness_px", self.softness_px, Range{0.5, 20}, "px",
                  "width of its edges: it is not in the retina's focus; source: our choice, by eye");
    visitor.field("shadow_depth", self.shadow_depth, Range{0, 1}, "of the light",
                  "what the shadow takes away; source: our choice, by eye");
  }
};

/// Where the instrument is, frame px.
struct InstrumentPose {
  bool present = false;      ///< the tip lies in the picture
  cv::Point2d tip;           ///< the very end of the shaft
  double shaft_angle = 0.0;  ///< where the tip points, rad, image axes
  double shaft_width = 0.0;
};

class Instrument {
 public:
  Instrument(const InstrumentOptions& options, cv::Size view, double px_scale, double duration_s, std::uint64_t seed);

  InstrumentPose at(double t_s) const;
  /// Of the shaft, px.
  double width() const { return width_px_; }

  /// Blends the shaft into `picture` (CV_32FC4, white = 1); its light is even, for it is much nearer to the light pipe.
  /// @return  how many pixels it covers by half or more, counted where `field` > 0.5
  int draw(const InstrumentPose& pose, const cv::Mat_<float>& field, cv::Mat& picture) const;
  /// Takes the shadow's part from the light.
  void castShadow(const InstrumentPose& pose, cv::Mat_<float>& light) const;

 private:
  struct Wave {
    double amplitude, hz, phase;
    double at(double t) const;
  };
  struct Visit {
    double from_s, to_s;
  };

  void planVisits(double duration_s, Random& random);
  double retreat(double t_s) const;
  cv::Rect reach(const InstrumentPose& pose, double margin_px) const;
  cv::Range columnsNear(const InstrumentPose& pose, double margin, int y, const cv::Rect& area) const;
  double distanceOutside(double behind_px, double aside_px, double width_px) const;

  InstrumentOptions options_;
  cv::Size view_;
  double px_scale_;
  double width_px_ = 0.0;
  double angle_ = 0.0;
  cv::Point2d place_;
  cv::Point2d shadow_offset_;
  std::vector<Wave> x_, y_, turn_;
  std::vector<Visit> visits_;
  std::vector<float> brushed_;
};

}  // namespace eyeslam::simulation
