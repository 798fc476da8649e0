// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace eyeslam::files {

/// Reads a picture that a human named.
/// @param what    what it is to him, for the error: "--retina"
/// @param mode    of cv::imread
/// @param wanted  what would be right
/// @throws FileError in one line
cv::Mat readPicture(const std::string& what, const std::string& path, int mode,
                    const std::string& wanted = "JPEG, PNG or TIFF");

}  // namespace eyeslam::files
