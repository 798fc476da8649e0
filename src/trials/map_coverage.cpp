// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/map_coverage.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "eyeslam/retina/units.h"

namespace eyeslam::trials {

namespace {

constexpr std::uint8_t kVessel = 128;

std::optional<double> share(double part, double whole)
{
  return whole > 0.0 ? std::optional<double>(part / whole) : std::nullopt;
}

// The cell that a place lies in, where the map has seen it.
std::optional<cv::Point> seenCell(const retina::VesselMap& map, const Eigen::Vector2d& at)
{
  const cv::Point cell(static_cast<int>(std::lround((at.x() - map.origin_x) / map.px_per_cell)),
                       static_cast<int>(std::lround((at.y() - map.origin_y) / map.px_per_cell)));
  if (!cv::Rect(0, 0, map.width, map.height).contains(cell)) return {};
  return map.seen[map.index(cell.x, cell.y)] > 0 ? std::optional<cv::Point>(cell) : std::nullopt;
}

}  // namespace

std::size_t calibreClass(double calibre_m)
{
  return static_cast<std::size_t>(std::upper_bound(kCalibreEdges_m.begin(), kCalibreEdges_m.end(), calibre_m) -
                                  kCalibreEdges_m.begin());
}

MapCoverage compareMap(const retina::VesselMap& found, const retina::VesselMap& truth,
                       const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& found_T)
{
  // Each cell of the map that a true vessel or its surroundings fall into.
  const auto cells = static_cast<std::size_t>(found.width) * static_cast<std::size_t>(found.height);
  std::vector<std::uint8_t> near(cells);
  std::array<double, 3> whole{}, mapped{};
  for (int row = 0; row < truth.height; ++row) {
    for (int column = 0; column < truth.width; ++column) {
      const std::size_t index = truth.index(column, row);
      if (truth.probability[index] < kVessel) continue;
      const Eigen::Vector2d at(truth.origin_x + column * truth.px_per_cell, truth.origin_y + row * truth.px_per_cell);
      const std::optional<cv::Point> cell = seenCell(found, found_T(at));
      if (!cell) continue;
      const std::size_t kind = calibreClass(kMicro * truth.um_per_px * truth.calibre_px[index]);
      whole[kind] += 1.0;
      mapped[kind] += found.probability[found.index(cell->x, cell->y)] >= kVessel ? 1.0 : 0.0;
      near[found.index(cell->x, cell->y)] = 1;
    }
  }
  MapCoverage score;
  for (std::size_t kind = 0; kind < whole.size(); ++kind) score.coverage[kind] = share(mapped[kind], whole[kind]);
  if (cells == 0) return score;
  cv::Mat_<std::uint8_t> around(found.height, found.width, near.data());
  cv::dilate(around, around, cv::Mat::ones(3, 3, CV_8U));
  double vessels = 0.0, right = 0.0;
  for (std::size_t i = 0; i < cells; ++i) {
    if (found.probability[i] < kVessel || found.seen[i] == 0) continue;
    vessels += 1.0;
    right += near[i];
  }
  score.precision = share(right, vessels);
  return score;
}

}  // namespace eyeslam::trials
