// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/spurious_detection_filter.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::tracking {

namespace {

enum Mark : std::uint8_t { kColour = 1, kBloom = 2, kRim = 4, kInstrument = 8 };

using Cells = cv::Mat_<std::uint8_t>;

// Gives the bit to every cell within `radius` cells, along rows and columns, of one that has it.
void spread(Cells& marks, std::uint8_t bit, int radius, Cells& scratch)
{
  marks.copyTo(scratch);
  for (int y = 0; y < marks.rows; ++y) {
    int last = -1 - radius;
    for (int x = 0; x < marks.cols; ++x) {
      if ((marks(y, x) & bit) == 0) continue;
      for (int u = std::max({0, last + radius + 1, x - radius}); u <= std::min(marks.cols - 1, x + radius); ++u)
        scratch(y, u) = static_cast<std::uint8_t>(scratch(y, u) | bit);
      last = x;
    }
  }
  for (int y = 0; y < marks.rows; ++y) {
    for (int v = std::max(0, y - radius); v <= std::min(marks.rows - 1, y + radius); ++v) {
      const std::uint8_t* from = scratch[v];
      std::uint8_t* to = marks[y];
      for (int x = 0; x < marks.cols; ++x) to[x] = static_cast<std::uint8_t>(to[x] | (from[x] & bit));
    }
  }
}

// Takes the bit from cells that have it almost alone: a single white cell is a glint, not a bloom.
void keepLarge(Cells& marks, std::uint8_t bit, Cells& scratch)
{
  constexpr int kLeast = 4;  // cells of the nine
  marks.copyTo(scratch);
  for (int y = 0; y < marks.rows; ++y) {
    for (int x = 0; x < marks.cols; ++x) {
      if ((scratch(y, x) & bit) == 0) continue;
      int alike = 0;
      for (int v = std::max(0, y - 1); v <= std::min(marks.rows - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(marks.cols - 1, x + 1); ++u) alike += (scratch(v, u) & bit) != 0;
      if (alike < kLeast) marks(y, x) = static_cast<std::uint8_t>(marks(y, x) & ~bit);
    }
  }
}

}  // namespace

SpuriousDetectionFilter::SpuriousDetectionFilter(const SpuriousDetectionFilterOptions& options) : options_(options) {}

SpuriousDetectionFilter::Removed SpuriousDetectionFilter::removeFrom(VesselPoints& points, const Frame& frame,
                                                                     const OcclusionMask& mask)
{
  markCells(frame, mask);
  Removed removed;
  const auto isSpurious = [&](const VesselPoint& point) {
    const int column = std::clamp(static_cast<int>(point.x) / Frame::kCell, 0, marks_.cols - 1);
    const int row = std::clamp(static_cast<int>(point.y) / Frame::kCell, 0, marks_.rows - 1);
    const std::uint8_t mark = marks_(row, column);
    if (mark == 0) return false;
    if (mark & kColour) return ++removed.colour > 0;
    if (mark & kBloom) return ++removed.bloom > 0;
    if (mark & kRim) return ++removed.rim > 0;
    return runsAlongBrightEdge(point, mask) && ++removed.instrument > 0;
  };
  points.erase(std::remove_if(points.begin(), points.end(), isSpurious), points.end());
  return removed;
}

void SpuriousDetectionFilter::markCells(const Frame& frame, const OcclusionMask& mask)
{
  const Cells& red = frame.cellRed();
  const Cells& blue = frame.cellBlue();
  marks_.create(red.rows, red.cols);
  scratch_.create(red.rows, red.cols);
  const auto median_red = static_cast<float>(mask.medianRed());
  const float dark = static_cast<float>(options_.darkest_red) * median_red;
  const auto redness = static_cast<float>(options_.least_redness);
  const auto whiteness = static_cast<float>(options_.bloom_whiteness);
  for (int y = 0; y < red.rows; ++y) {
    const std::uint8_t* reds = red[y];
    const std::uint8_t* blues = blue[y];
    const std::uint16_t* greens = frame.cellGreen()[y];
    const std::uint8_t* hidden = mask.cells()[y];
    const std::uint8_t* bright = mask.brightCells()[y];
    std::uint8_t* marks = marks_[y];
    for (int x = 0; x < red.cols; ++x) {
      const float r = reds[x];
      const float g = static_cast<float>(greens[x]) / 4.0F;
      const float b = blues[x];
      const bool colour = !frame.isGrey() && (r < dark || r < redness * (r + g + b));
      const bool white = frame.isGrey() ? bright[x] != 0 : std::min(g, b) > whiteness * r && r > median_red;
      const bool rim = (hidden[x] & OcclusionMask::kRim) != 0;
      marks[x] = static_cast<std::uint8_t>((colour ? kColour : 0) | (white ? kBloom : 0) | (rim ? kRim : 0) |
                                           (bright[x] ? kInstrument : 0));
    }
  }
  keepLarge(marks_, kBloom, scratch_);
  spread(marks_, kBloom, options_.bloom_distance_cells, scratch_);
  spread(marks_, kRim, options_.rim_distance_cells, scratch_);
  spread(marks_, kInstrument, options_.instrument_distance_cells, scratch_);
}

// Across the direction to the middle of the bright cells nearby. A vessel that passes under the instrument points at
// it.
bool SpuriousDetectionFilter::runsAlongBrightEdge(const VesselPoint& point, const OcclusionMask& mask) const
{
  const Cells& bright = mask.brightCells();
  const int reach = options_.instrument_distance_cells;
  const int column = static_cast<int>(point.x) / Frame::kCell;
  const int row = static_cast<int>(point.y) / Frame::kCell;
  double sum_x = 0.0, sum_y = 0.0;
  for (int y = std::max(0, row - reach); y <= std::min(bright.rows - 1, row + reach); ++y) {
    for (int x = std::max(0, column - reach); x <= std::min(bright.cols - 1, column + reach); ++x) {
      if (bright(y, x) == 0) continue;
      sum_x += x - column;
      sum_y += y - row;
    }
  }
  const double distance = std::hypot(sum_x, sum_y);
  if (distance == 0.0) return false;
  const double towards = (std::cos(point.direction) * sum_x + std::sin(point.direction) * sum_y) / distance;
  return std::abs(towards) < std::sin(options_.instrument_angle_deg * CV_PI / 180.0);
}

}  // namespace eyeslam::tracking
