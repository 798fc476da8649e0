// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace eyeslam::files {

/// Text as it may stand in HTML, SVG and in their quoted attributes: & < > " ' written out; bytes that are no UTF-8,
/// and letters that XML forbids, become question marks.
std::string escaped(const std::string& text);

/// Bytes as an address that holds them itself. @param type  "image/jpeg"
std::string dataAddress(const std::string& type, const std::vector<unsigned char>& bytes);

/// A picture as such an address (data:image/png;base64,...). @param bgr  8 bit
std::string pngAddress(const cv::Mat& bgr);

}  // namespace eyeslam::files
