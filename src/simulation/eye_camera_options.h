// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "eyeslam/retina/options.h"

namespace eyeslam::simulation {

struct EyeCameraOptions {
  std::string condition = "human";
  int width = 800;
  int height = 608;
  double fps = 30.0;
  double exposure_ms = 8.0;
  double reach_mm = 1.5;
  double duration_s = 600.0;
  double drift_um = 15.0;
  double drift_s = 10.0;
  double widening = 1.0;
  double view_x_mm = -1.0;
  double view_y_mm = -1.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.choice("condition", self.condition,
                   {"human", "paper", "porcine", "laser", "saccade", "blackout", "plain", "deform", "excursion", "hd"},
                   "how the retina looks; its motion is not used; source: contracts, 5 and 7");
    visitor.field("width", self.width, Range{64, 4096}, "px", "of a frame; source: facts, B3");
    visitor.field("height", self.height, Range{64, 4096}, "px", "of a frame; source: facts, B3");
    visitor.field("fps", self.fps, Range{1, 1000}, "1/s", "frames a second; source: facts, B3");
    visitor.field("exposure_ms", self.exposure_ms, Range{0, 100}, "ms",
                  "at most a frame's time; source: loop study, 1: 8 at 30 Hz, 4 at 120 Hz");
    visitor.field("reach_mm", self.reach_mm, Range{0, 10}, "mm",
                  "how far the retina may leave its place: it is painted as far; source: RetinaMotionOptions.reach_mm");
    visitor.field("duration_s", self.duration_s, Range{1, 1e5}, "s",
                  "over which blooms and blackouts come and go; source: issue, 10 minutes");
    visitor.field("drift_um", self.drift_um, Range{0, 1000}, "um",
                  "RMS per axis by which the picture wanders against the manipulator; source: loop study, 1");
    visitor.field("drift_s", self.drift_s, Range{0.01, 1000}, "s",
                  "time constant of the wandering; source: loop study, 1");
    visitor.field(
        "widening", self.widening, Range{0.25, 4}, "",
        "of the view by the surgeon's zoom, times what the condition shows; source: a pattern must be in view");
    visitor.field("view_x_mm", self.view_x_mm, Range{-1, 100}, "mm",
                  "of the retina's picture under the image's centre at the start; -1: looked for; source: the surgeon");
    visitor.field("view_y_mm", self.view_y_mm, Range{-1, 100}, "mm", "the same downwards; source: the surgeon");
  }
};

/// Width of a px on the retina, that the condition has for a seed and a width.
double umPerPx(const EyeCameraOptions& options, std::uint64_t seed);
/// Of a frame, s.
inline double exposureTime(const EyeCameraOptions& options)
{
  return std::min(options.exposure_ms * 1e-3, 1.0 / options.fps);
}
/// Of the image, px.
inline cv::Point2d imageCentre(const EyeCameraOptions& options)
{
  return {(options.width - 1) / 2.0, (options.height - 1) / 2.0};
}

}  // namespace eyeslam::simulation
