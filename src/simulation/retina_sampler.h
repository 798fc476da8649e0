// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "eyeslam/retina/pose2.h"

namespace eyeslam::simulation {

/// Where a frame pixel lies on the canvas: the pose about the image centre, then the canvas's origin, then a warp that
/// is quadratic in the pixel's offset from the image centre.
struct ViewMapping {
  retina::Pose2 map_T_frame;        ///< px
  std::array<double, 6> warp = {};  ///< x^2, xy, y^2 to x, then to y; 1/px; in the map's axes
  cv::Point2d map_origin;           ///< map coordinates of the canvas's pixel (0, 0), px
};

/// What a view takes of one mapping, where it is the sum of several.
struct Share {
  float weight = 1.0F;
  bool is_first = true;  ///< the view has none yet: what is in it does not count
};

/// Adds the share's weight x the canvas, as seen through the mapping, to `view`.
///
/// Catmull-Rom interpolation at exact positions: OpenCV's warps round theirs to 1/32 px, more than the truth may be
/// off. Positions outside the canvas take its border's colour.
/// @param canvas  CV_32FC4, at least 4 x 4
/// @param view    CV_32FC4, of the size of the view
void accumulateView(const cv::Mat& canvas, const ViewMapping& mapping, const Share& share, cv::Mat& view);

}  // namespace eyeslam::simulation
