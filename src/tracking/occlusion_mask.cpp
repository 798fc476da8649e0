// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/occlusion_mask.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "eyeslam/tracking/cell_growth.h"

namespace eyeslam::tracking {

namespace {

// The level below which half of the cells lie that are not black; 0 when all are black.
int medianAboveBlack(const cv::Mat_<std::uint8_t>& cells)
{
  std::array<int, 256> histogram{};
  int total = 0;
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.cols; ++x) {
      if (cells(y, x) <= Frame::kBlack) continue;
      ++histogram[cells(y, x)];
      ++total;
    }
  }
  int level = Frame::kBlack;
  for (int below = 0; total > 0 && 2 * below < total; ++level) below += histogram[static_cast<std::size_t>(level) + 1];
  return total > 0 ? level : 0;
}

}  // namespace

OcclusionMask::OcclusionMask(const OcclusionMaskOptions& options) : options_(options) {}

void OcclusionMask::update(const Frame& frame)
{
  const cv::Mat_<std::uint8_t>& red = frame.cellRed();
  const cv::Mat_<std::uint8_t>& blue = frame.cellBlue();
  width_ = frame.width();
  height_ = frame.height();
  for (auto* cells : {&cells_, &bright_, &rough_, &scratch_}) cells->create(red.rows, red.cols);

  median_red_ = medianAboveBlack(red);
  const int rim = static_cast<int>(options_.rim_red * median_red_);
  const int bright_grey = static_cast<int>(options_.bright_grey * median_red_);
  for (int y = 0; y < red.rows; ++y) {
    for (int x = 0; x < red.cols; ++x) {
      const bool bright = frame.isGrey() ? red(y, x) > bright_grey : blue(y, x) > options_.bright_blue * red(y, x);
      const bool dark = red(y, x) < rim || red(y, x) <= Frame::kBlack;
      bright_(y, x) = bright && !dark ? 1 : 0;
      rough_(y, x) = static_cast<std::uint8_t>((dark ? kRim : kVisible) | (bright ? kBright : kVisible));
    }
  }
  for (int y = 0; y < cells_.rows; ++y) std::fill_n(cells_[y], cells_.cols, kVisible);  // setTo would allocate
  growBits(rough_, 0xFF, options_.growth_cells, scratch_, cells_);
  const int visible = static_cast<int>(cells_.total()) - cv::countNonZero(cells_);
  visible_fraction_ = static_cast<double>(visible) / static_cast<double>(cells_.total());
}

}  // namespace eyeslam::tracking
