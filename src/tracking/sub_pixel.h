// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

namespace eyeslam::tracking {

/// OpenCV's drawing takes fractions of a pixel as whole numbers with so many bits more (its `shift`): sixteenths.
inline constexpr int kSubPixelBits = 4;

inline cv::Point inSubPixels(cv::Point2d at)
{
  return {cvRound(at.x * (1 << kSubPixelBits)), cvRound(at.y * (1 << kSubPixelBits))};
}

}  // namespace eyeslam::tracking
