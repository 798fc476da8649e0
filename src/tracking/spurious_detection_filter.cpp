// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/spurious_detection_filter.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"
#include "eyeslam/retina/vector_kernel.h"
#include "eyeslam/tracking/cell_growth.h"

namespace eyeslam::tracking {

namespace {

enum Mark : std::uint8_t { kColour = 1, kBloom = 2, kRim = 4, kInstrument = 8 };

using Cells = cv::Mat_<std::uint8_t>;

// What the colour of a cell says, for frames that have one.
EYESLAM_VECTOR_KERNEL void markColours(const std::uint8_t* red, const std::uint16_t* green, const std::uint8_t* blue,
                                       int count, float dark, float redness, float whiteness, float median_red,
                                       std::uint8_t* marks)
{
  for (int i = 0; i < count; ++i) {
    const auto r = static_cast<float>(red[i]);
    const float g = static_cast<float>(green[i]) / 4.0F;
    const auto b = static_cast<float>(blue[i]);
    const int colour = static_cast<int>(r < dark) | static_cast<int>(r < redness * (r + g + b));
    const int white = static_cast<int>(std::min(g, b) > whiteness * r) & static_cast<int>(r > median_red);
    marks[i] = static_cast<std::uint8_t>(colour * kColour | white * kBloom);
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
  const int columns = frame.cellRed().cols;
  marks_.create(frame.cellRed().rows, columns);
  scratch_.create(marks_.rows, columns);
  const auto median_red = static_cast<float>(mask.medianRed());
  const float dark = static_cast<float>(options_.darkest_red) * median_red;
  const auto redness = static_cast<float>(options_.least_redness);
  const auto whiteness = static_cast<float>(options_.bloom_whiteness);
  for (int y = 0; y < marks_.rows; ++y) {
    const std::uint8_t* hidden = mask.cells()[y];
    const std::uint8_t* bright = mask.brightCells()[y];
    std::uint8_t* marks = marks_[y];
    if (frame.isGrey()) {
      std::transform(bright, bright + columns, marks, [](std::uint8_t is) { return is * kBloom; });
    } else {
      markColours(frame.cellRed()[y], frame.cellGreen()[y], frame.cellBlue()[y], columns, dark, redness, whiteness,
                  median_red, marks);
    }
    for (int x = 0; x < columns; ++x) {
      const int rim = (hidden[x] & OcclusionMask::kRim) != 0 ? kRim : 0;
      marks[x] = static_cast<std::uint8_t>(marks[x] | rim | bright[x] * kInstrument);
    }
  }
  keepLarge(marks_, kBloom, scratch_);
  growBits(marks_, kBloom, options_.bloom_distance_cells, scratch_, marks_);
  growBits(marks_, kRim, options_.rim_distance_cells, scratch_, marks_);
  growBits(marks_, kInstrument, options_.instrument_distance_cells, scratch_, marks_);
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
  return std::abs(towards) < std::sin(options_.instrument_angle_deg * kPi / 180.0);
}

}  // namespace eyeslam::tracking
