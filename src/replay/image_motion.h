// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <optional>

namespace eyeslam::replay {

/// How far the picture moved between two frames, from nothing but their pixels: phase correlation of small, high-passed
/// green pictures; about 1 ms a frame of 800 x 608.
class ImageMotion {
 public:
  /// @param image  8 or 16 bit, one or three channels
  /// @return displacement of the content since the frame before, full px; none for the first frame, one of another
  ///         size, and where nothing in both is alike (dark, covered)
  std::optional<cv::Point2d> add(const cv::Mat& image);

 private:
  cv::Mat reduced(const cv::Mat& image);

  cv::Mat green_, before_, window_;
};

}  // namespace eyeslam::replay
