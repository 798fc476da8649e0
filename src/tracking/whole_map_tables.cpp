// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/whole_map_tables.h"

#include <algorithm>

namespace eyeslam::tracking {

namespace {

constexpr int kBandRows = 16;
constexpr int kOperationsPerCell = 2;  // of the tables, and of the map; measured, pooling and copying

std::uint8_t larger(std::uint8_t a, std::uint8_t b) { return std::max(a, b); }

}  // namespace

cv::Rect WholeMapTables::areaOf(const cv::Rect& known, int reduction, int margin)
{
  const cv::Point first(floorDivide(known.x, reduction) - margin, floorDivide(known.y, reduction) - margin);
  const cv::Point last(floorDivide(known.x + known.width - 1, reduction) + margin,
                       floorDivide(known.y + known.height - 1, reduction) + margin);
  return {first, last + cv::Point(1, 1)};
}

bool WholeMapTables::update(const OccupancyMap& map, int reduction, int margin, std::int64_t operations)
{
  const cv::Rect area = areaOf(map.knownCells(), reduction, margin);
  const int bands = (area.height + kBandRows - 1) / kBandRows;
  if (!coversOnly(area, reduction)) {
    area_ = area;
    reduction_ = reduction;
    tables_.resize(area.size());
    made_.assign(static_cast<std::size_t>(bands), 0);
    copy_.resize(static_cast<std::size_t>(area.width * reduction * reduction));
  }
  const std::int64_t cost = std::int64_t{area.width} * kBandRows * kOperationsPerCell * (1 + reduction * reduction);
  // From below, because the bounds of a band reach into the rows under it.
  for (int band = bands - 1; band >= 0; --band) {
    if (isCurrent(map, band)) continue;
    if (operations <= 0) return false;
    make(map, band);
    operations -= cost;
  }
  return true;
}

bool WholeMapTables::coversOnly(const cv::Rect& area, int reduction) const
{
  return area == area_ && reduction == reduction_ && !made_.empty();
}

cv::Rect WholeMapTables::rowsOf(int band) const
{
  const int first = band * kBandRows;
  return {0, first, area_.width, std::min(kBandRows, area_.height - first)};
}

bool WholeMapTables::isCurrent(const OccupancyMap& map, int band) const
{
  const std::uint32_t made = made_[static_cast<std::size_t>(band)];
  if (made == 0 || made < map.clearedAt()) return false;
  const cv::Rect rows = rowsOf(band);
  const int first = floorDivide((area_.y + rows.y) * reduction_, OccupancyMap::kTile);
  const int last = floorDivide((area_.y + rows.y + rows.height) * reduction_ - 1, OccupancyMap::kTile);
  const auto& tiles = map.tiles();
  for (int ty = first; ty <= last; ++ty) {
    for (int tx = tiles.firstX(); tx < tiles.endX(); ++tx) {
      const OccupancyMap::Tile* tile = tiles.find(tx, ty);
      if (tile && tile->changes > made) return false;
    }
  }
  return true;
}

void WholeMapTables::make(const OccupancyMap& map, int band)
{
  const cv::Rect rows = rowsOf(band);
  cv::Mat_<std::uint8_t> copy(reduction_, area_.width * reduction_, copy_.data());
  for (int y = rows.y; y < rows.y + rows.height; ++y) {
    map.copyWindow({area_.x * reduction_, (area_.y + y) * reduction_, copy.cols, copy.rows}, copy);
    std::uint8_t* row = tables_.row(y);
    for (int r = 1; r < reduction_; ++r) std::transform(copy[0], copy[0] + copy.cols, copy[r], copy[0], larger);
    for (int x = 0; x < area_.width; ++x)
      row[x] = *std::max_element(copy[0] + x * reduction_, copy[0] + (x + 1) * reduction_);
  }
  const int reach = MaxPooledTables::kBlock - 1;
  tables_.pool(std::max(0, rows.y - reach), rows.y + rows.height);
  made_[static_cast<std::size_t>(band)] = std::max(1U, map.changes());
}

}  // namespace eyeslam::tracking
