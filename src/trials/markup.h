// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace eyeslam::trials {

/// Text as it may stand in HTML, SVG and in their quoted attributes: & < > " ' written out; bytes that are no UTF-8,
/// and letters that XML forbids, become question marks.
std::string escaped(const std::string& text);

/// A picture as an address that holds the picture itself (data:image/png;base64,...). @param bgr  8 bit
std::string pngAddress(const cv::Mat& bgr);

}  // namespace eyeslam::trials
