// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

namespace eyeslam::files {

/// The centrelines of a picture's non-zero regions, one px wide, as 0 and 255; regions stay connected.
/// Source: Zhang and Suen 1984, a fast parallel algorithm for thinning digital patterns.
cv::Mat_<std::uint8_t> thinned(const cv::Mat_<std::uint8_t>& regions);

}  // namespace eyeslam::files
