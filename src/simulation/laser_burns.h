// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/options.h"

namespace eyeslam::simulation {

/// Photocoagulation through the instrument. Lengths in frame px of a view 800 px wide.
struct LaserBurnsOptions {
  int first_frame = 50;
  int every_frames = 0;
  double burn_px = 8.0;
  double whiteness = 0.55;
  double aiming_px = 4.5;
  int flash_frames = 2;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("first_frame", self.first_frame, Range{0, 1e6}, "",
                  "frame of the first pulse; source: rendered sequences");
    visitor.field("every_frames", self.every_frames, Range{0, 1e6}, "",
                  "frames between pulses, 0 = no laser; source: rendered sequences, 25");
    visitor.field("burn_px", self.burn_px, Range{0.5, 200}, "px", "radius of a burn; source: rendered sequences");
    visitor.field("whiteness", self.whiteness, Range{0, 1}, "",
                  "how far the retina turns white in the middle; source: our choice, by eye");
    visitor.field("aiming_px", self.aiming_px, Range{0.5, 100}, "px",
                  "radius of the aiming spot; source: our choice, by eye");
    visitor.field("flash_frames", self.flash_frames, Range{1, 30}, "",
                  "how long the pulse lights the spot; source: rendered sequences, 2");
  }
};

class LaserBurns {
 public:
  LaserBurns(const LaserBurnsOptions& options, double px_scale);

  bool hasLaser() const { return options_.every_frames > 0; }
  bool fires(int frame) const;
  /// The pulse that lights frame `frame`, 0 before the first and between pulses, 1 while one goes on.
  double flash(int frame) const;
  /// Turns the canvas (CV_32FC4) white around a place, px of the canvas; it stays so.
  void burn(cv::Mat& canvas, cv::Point2d place) const;
  /// Adds the aiming spot, or the pulse's light, to a picture (CV_32FC4, white = 1).
  void addSpot(cv::Mat& picture, cv::Point2d place, int frame) const;
  /// The same by shares of the exposure, [0, 1], in which the aiming beam and the pulse were on.
  void addLight(cv::Mat& picture, cv::Point2d place, double aiming, double flash) const;

 private:
  LaserBurnsOptions options_;
  double px_scale_;
};

}  // namespace eyeslam::simulation
