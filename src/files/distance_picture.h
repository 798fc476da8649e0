// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/imgproc.hpp>

namespace eyeslam::files {

/// Distance of each px to the nearest non-zero one; everywhere far when there is none.
inline cv::Mat_<float> distanceTo(const cv::Mat_<std::uint8_t>& marked)
{
  cv::Mat_<float> distance(marked.size(), 1e9F);
  if (cv::countNonZero(marked) > 0) cv::distanceTransform(marked == 0, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distance;
}

}  // namespace eyeslam::files
