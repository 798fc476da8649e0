// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/occupancy_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace eyeslam::tracking {

namespace {

constexpr int kCellTile = OccupancyMap::kTile;

int floorModulo(int a, int b) { return a - b * floorDivide(a, b); }
// Cells are counted from far outside the reach, so that unsigned division, a shift, rounds down.
constexpr unsigned kFarOutside = 2 * OccupancyMap::kReach_cells;
static_assert(kFarOutside % kCellTile == 0);
int tileOf(int cell)
{
  return static_cast<int>((static_cast<unsigned>(cell) + kFarOutside) / kCellTile) -
         static_cast<int>(kFarOutside / kCellTile);
}
std::size_t indexInTile(int i, int j)
{
  return ((static_cast<unsigned>(j) + kFarOutside) % kCellTile) * kCellTile +
         (static_cast<unsigned>(i) + kFarOutside) % kCellTile;
}

bool withinReach(double i, double j)
{
  // Written so that NaN is out of reach.
  return std::abs(i) < OccupancyMap::kReach_cells && std::abs(j) < OccupancyMap::kReach_cells;
}

cv::Rect withinReach(const cv::Rect2d& box)
{
  const double reach = OccupancyMap::kReach_cells;
  if (!std::isfinite(box.x + box.y + box.width + box.height)) return {};
  const cv::Rect2d cut = box & cv::Rect2d(-reach, -reach, 2 * reach, 2 * reach);
  const int left = static_cast<int>(std::floor(cut.x)), top = static_cast<int>(std::floor(cut.y));
  if (cut.empty()) return {};
  return {left, top, static_cast<int>(std::ceil(cut.br().x)) - left, static_cast<int>(std::ceil(cut.br().y)) - top};
}

/// Box around the view in the map, cells.
cv::Rect2d boxOfView(const cv::Size& view, const retina::Pose2& map_T_frame, double cell_px)
{
  const Eigen::Vector2d half(view.width / 2.0, view.height / 2.0);
  const Eigen::Vector2d reach = map_T_frame.linear().cwiseAbs() * half / cell_px;
  const Eigen::Vector2d low = map_T_frame.translation() / cell_px - reach;
  return {low.x(), low.y(), 2.0 * reach.x(), 2.0 * reach.y()};
}

}  // namespace

OccupancyMap::OccupancyMap(const OccupancyMapOptions& options) : options_(options) {}

void OccupancyMap::add(const ScanPoints& points, const retina::Pose2& map_T_frame)
{
  const Eigen::Matrix2d linear = map_T_frame.linear() / options_.cell_px;
  const Eigen::Vector2d shift = map_T_frame.translation() / options_.cell_px;
  for (const Eigen::Vector2f& point : points) {
    const Eigen::Vector2d cell = linear * point.cast<double>() + shift;
    if (withinReach(cell.x(), cell.y())) {
      hit(static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y())));
    }
  }
  ++changes_;
}

void OccupancyMap::hit(int i, int j)
{
  const cv::Rect touched(i - 1, j - 1, 3, 3);
  known_ = known_.empty() ? touched : known_ | touched;
  for (int dj = -1; dj <= 1; ++dj) {
    for (int di = -1; di <= 1; ++di) {
      const int across = std::abs(di) + std::abs(dj);
      if (across == 0) raise(i, j, options_.hit_centre, options_.most_centre);
      if (across == 1) raise(i + di, j + dj, options_.hit_edge, options_.most_edge);
      if (across == 2) raise(i + di, j + dj, options_.hit_corner, options_.most_corner);
    }
  }
}

void OccupancyMap::raise(int i, int j, int hit, int most)
{
  Tile& tile = tiles_.at(tileOf(i), tileOf(j));
  std::uint8_t& cell = tile.cells[indexInTile(i, j)];
  // A centre's 255 is not lowered to the 190 of a neighbour's edge.
  cell = static_cast<std::uint8_t>(std::max<int>(cell, std::min(cell + hit, most)));
  tile.changes = changes_ + 1;
}

void OccupancyMap::decay(const OcclusionMask& mask, const cv::Size& view, const retina::Pose2& map_T_frame,
                         std::int64_t frame)
{
  if (!(std::abs(map_T_frame.scale) > 0.0)) return;
  const cv::Rect box = withinReach(boxOfView(view, map_T_frame, options_.cell_px)) & known_;
  const retina::Pose2 frame_T_map = map_T_frame.inverse();
  const int turn = static_cast<int>(frame % options_.decay_period);
  for (int j = box.y; j < box.y + box.height; ++j) {
    if (floorModulo(j, options_.decay_period) == turn) decayRow(mask, view, frame_T_map, j, box);
  }
  ++changes_;
}

void OccupancyMap::decayRow(const OcclusionMask& mask, const cv::Size& view, const retina::Pose2& frame_T_map, int j,
                            const cv::Rect& box)
{
  const double cell_px = options_.cell_px;
  const Eigen::Vector2d centre((view.width - 1) / 2.0, (view.height - 1) / 2.0);
  const Eigen::Vector2d first = frame_T_map * Eigen::Vector2d(0.5 * cell_px, (j + 0.5) * cell_px) + centre;
  const Eigen::Vector2d step = frame_T_map.linear().col(0) * cell_px;
  for (int i = box.x; i < box.x + box.width;) {
    const int end = std::min(box.x + box.width, (floorDivide(i, kTile) + 1) * kTile);
    Tile* tile = tiles_.find(floorDivide(i, kTile), floorDivide(j, kTile));
    for (; tile && i < end; ++i) {
      std::uint8_t& cell = tile->cells[indexInTile(i, j)];
      if (cell == 0) continue;
      const Eigen::Vector2d pixel = first + i * step;
      if (!mask.isVisible(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())))) continue;
      cell = static_cast<std::uint8_t>(std::max(0, cell - options_.decay));
      tile->changes = changes_ + 1;
    }
    i = end;
  }
}

void OccupancyMap::clear()
{
  tiles_.clear();
  known_ = {};
  cleared_at_ = ++changes_;
}

std::uint8_t OccupancyMap::cell(int i, int j) const
{
  const Tile* tile = tiles_.find(floorDivide(i, kTile), floorDivide(j, kTile));
  return tile ? tile->cells[indexInTile(i, j)] : std::uint8_t{0};
}

void OccupancyMap::copyWindow(const cv::Rect& cells, cv::Mat_<std::uint8_t>& window) const
{
  window.create(cells.size());
  for (int y = 0; y < cells.height; ++y) {
    const int j = cells.y + y;
    std::uint8_t* row = window[y];
    for (int x = 0; x < cells.width;) {
      const int i = cells.x + x;
      const int count = std::min(cells.width - x, (floorDivide(i, kTile) + 1) * kTile - i);
      const Tile* tile = tiles_.find(floorDivide(i, kTile), floorDivide(j, kTile));
      if (tile)
        std::memcpy(row + x, &tile->cells[indexInTile(i, j)], static_cast<std::size_t>(count));
      else
        std::memset(row + x, 0, static_cast<std::size_t>(count));
      x += count;
    }
  }
}

}  // namespace eyeslam::tracking
