// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace eyeslam::tracking {

/// Gives those of `bits` that a cell has to every cell of its (2 radius + 1) square; what `grown` has, stays.
/// @param scratch  of the same size; its content is lost
/// @param grown    of the same size; may be `cells` itself
void growBits(const cv::Mat_<std::uint8_t>& cells, std::uint8_t bits, int radius, cv::Mat_<std::uint8_t>& scratch,
              cv::Mat_<std::uint8_t>& grown);

}  // namespace eyeslam::tracking
