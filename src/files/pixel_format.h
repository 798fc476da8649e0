// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace eyeslam::files {

/// Whether a picture is bright enough for its colour to be judged.
bool isLit(const cv::Mat& image);

/// Whether blue, green and red are the same but for rounding: a grey picture stored as colour. Three channels, 8 or
/// 16 bit.
bool hasEqualChannels(const cv::Mat& image);

/// Brings a picture to what the tracker takes: 8 or 16 bit, one or three channels.
/// @return what had to be converted, in words, or empty; `image` is empty when it cannot be used
std::string makeUsable(cv::Mat& image);

/// "800 x 608, 3 channels of 8 bit"
std::string describe(const cv::Mat& image);

}  // namespace eyeslam::files
