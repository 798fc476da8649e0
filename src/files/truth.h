// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace eyeslam::files {

/// Where the view truly was in one frame (contracts, section 5): full-resolution px, deg.
struct TruthPose {
  double t_s = 0.0;
  double x_px = 0.0;
  double y_px = 0.0;
  double theta_deg = 0.0;
  double scale = 1.0;
  bool visible = true;  ///< false while the retina is hidden (light out, saccade out of view)
};

/// Where the instrument's tip truly was; full-resolution px of the frame.
struct TruthTool {
  bool present = false;
  double tip_x_px = 0.0;
  double tip_y_px = 0.0;
  double shaft_angle_deg = 0.0;  ///< where the tip points, image axes
  double shaft_width_px = 0.0;
};

/// The circle of light within the picture, full-resolution px.
struct Rim {
  double cx = 0.0;
  double cy = 0.0;
  double r = 0.0;
};

/// A sequence's truth as values: what `truth.csv`, `tool.csv`, `vessels.png` and `meta.json` say.
struct Truth {
  std::vector<TruthPose> poses;  ///< one a frame, from frame 0
  std::vector<TruthTool> tools;  ///< one a frame, or empty when there is no `tool.csv`
  cv::Size size;                 ///< of the video, full-resolution px
  double fps = 30.0;
  double um_per_px = 0.0;  ///< 0 = unknown
  std::optional<Rim> rim;
  cv::Mat_<std::uint8_t> vessels;  ///< calibre of the vessel at each map px, 0 = none; empty when there is no picture
  cv::Point2d vessels_origin;      ///< map coordinates of `vessels(0, 0)`
};

}  // namespace eyeslam::files
