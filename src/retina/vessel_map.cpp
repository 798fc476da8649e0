// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::retina {

std::vector<MapPoint> vesselPoints(const VesselMap& map)
{
  constexpr std::uint8_t kThreshold = 128;
  std::vector<MapPoint> points;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const std::size_t cell = map.index(column, row);
      if (map.probability[cell] < kThreshold) continue;
      points.push_back({map.origin_x + column * map.px_per_cell, map.origin_y + row * map.px_per_cell,
                        map.probability[cell] / 255.0, static_cast<double>(map.calibre_px[cell])});
    }
  }
  return points;
}

}  // namespace eyeslam::retina
