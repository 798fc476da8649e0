// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/cell_growth.h"

#include <algorithm>
#include <cstdlib>

#include "eyeslam/retina/vector_kernel.h"

namespace eyeslam::tracking {

namespace {

EYESLAM_VECTOR_KERNEL void orRow(const std::uint8_t* row, std::uint8_t bits, int count, std::uint8_t* into)
{
  for (int i = 0; i < count; ++i) into[i] = static_cast<std::uint8_t>(into[i] | (row[i] & bits));
}

}  // namespace

void growBits(const cv::Mat_<std::uint8_t>& cells, std::uint8_t bits, int radius, cv::Mat_<std::uint8_t>& scratch,
              cv::Mat_<std::uint8_t>& grown)
{
  for (int y = 0; y < cells.rows; ++y) {
    std::fill_n(scratch[y], cells.cols, std::uint8_t{0});
    for (int d = -radius; d <= radius; ++d) {
      const int from = std::max(0, -d);
      const int count = cells.cols - std::abs(d);
      if (count > 0) orRow(cells[y] + from + d, bits, count, scratch[y] + from);
    }
  }
  for (int y = 0; y < cells.rows; ++y) {
    for (int v = std::max(0, y - radius); v <= std::min(cells.rows - 1, y + radius); ++v)
      orRow(scratch[v], bits, cells.cols, grown[y]);
  }
}

}  // namespace eyeslam::tracking
