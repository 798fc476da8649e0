// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/baselines/view_count.h"

#include <cmath>

namespace eyeslam::baselines {

namespace {

using tracking::floorDivide;

std::size_t indexIn(int i, int j, int side)
{
  const int column = i - side * floorDivide(i, side);
  const int row = j - side * floorDivide(j, side);
  return static_cast<std::size_t>(row * side + column);
}

}  // namespace

void ViewCount::add(const tracking::OcclusionMask& mask, const cv::Size& frame, const retina::Pose2& map_T_frame)
{
  const retina::Pose2 frame_T_map = map_T_frame.inverse();
  const Eigen::Vector2d centre((frame.width - 1) / 2.0, (frame.height - 1) / 2.0);
  const double reach = map_T_frame.scale * centre.norm();
  const auto cellOf = [&](double place) { return static_cast<int>(std::floor(place / cell_px_)); };
  for (int j = cellOf(map_T_frame.y - reach); j <= cellOf(map_T_frame.y + reach); ++j) {
    for (int i = cellOf(map_T_frame.x - reach); i <= cellOf(map_T_frame.x + reach); ++i) {
      const Eigen::Vector2d p = frame_T_map * Eigen::Vector2d((i + 0.5) * cell_px_, (j + 0.5) * cell_px_) + centre;
      if (!mask.isVisible(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())))) continue;
      std::uint8_t& count = tiles_.at(floorDivide(i, kTile), floorDivide(j, kTile))[indexIn(i, j, kTile)];
      if (count < 255) ++count;
    }
  }
}

std::uint8_t ViewCount::at(int i, int j) const
{
  const Tile* tile = tiles_.find(floorDivide(i, kTile), floorDivide(j, kTile));
  return tile ? (*tile)[indexIn(i, j, kTile)] : std::uint8_t{0};
}

}  // namespace eyeslam::baselines
