// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/structure_check.h"

#include <algorithm>

namespace eyeslam::tracking {

namespace {

constexpr int kSmallArea = 2, kMiddleArea = 4, kLargeArea = 8;  // cells along an area
constexpr int kFewest = 4;                                      // areas, of which nothing can be said
constexpr int kManyLarge = 40;                                  // so that noise does not grow by chance

struct Sums {
  double count = 0.0, sum = 0.0, squares = 0.0;

  void add(double value, double weight = 1.0)
  {
    count += weight;
    sum += weight * value;
    squares += weight * value * value;
  }
  double mean() const { return sum / count; }
  double scatter() const { return std::max(0.0, squares - sum * sum / count); }
};

Sums sumsOf(const Frame& frame, const OcclusionMask& mask, const cv::Rect& area)
{
  Sums sums;
  for (int y = area.y; y < area.br().y; ++y) {
    for (int x = area.x; x < area.br().x; ++x) {
      if (mask.cells()(y, x) == OcclusionMask::kVisible) sums.add(frame.cellGreen()(y, x));
    }
  }
  return sums;
}

}  // namespace

StructureCheck::Unevenness StructureCheck::unevenness(const Frame& frame, const OcclusionMask& mask, int cells)
{
  const cv::Rect all({}, frame.cellGreen().size());
  Sums means;  // of areas, each weighed with its visible cells
  double within = 0.0;
  Unevenness result;
  for (int y = 0; y < all.height; y += cells) {
    for (int x = 0; x < all.width; x += cells) {
      const Sums area = sumsOf(frame, mask, cv::Rect(x, y, cells, cells) & all);
      if (2.0 * area.count < cells * cells) continue;
      ++result.areas;
      within += area.scatter();
      means.add(area.mean(), area.count);
    }
  }
  if (result.areas < 2) return result;
  const double between = means.scatter() / (result.areas - 1);
  const double inside = within / (means.count - result.areas);
  result.ratio = inside > 0.0 ? between / inside : 0.0;
  return result;
}

bool StructureCheck::isNoise(const Frame& frame, const OcclusionMask& mask) const
{
  const Unevenness middle = unevenness(frame, mask, kMiddleArea);
  if (middle.areas < kFewest) return false;
  if (middle.ratio < options_.least_structure) return true;
  const Unevenness large = unevenness(frame, mask, kLargeArea);
  return large.areas >= kManyLarge && large.ratio < options_.least_growth * unevenness(frame, mask, kSmallArea).ratio;
}

}  // namespace eyeslam::tracking
