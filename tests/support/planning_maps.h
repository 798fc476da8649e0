// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::support {

/// A map without vessels, seen everywhere in 100 frames.
inline retina::VesselMap emptyMap(int width, int height, double px_per_cell = 2.0, double um_per_px = 5.0)
{
  retina::VesselMap map;
  map.width = width;
  map.height = height;
  map.origin_x = 0.5;
  map.origin_y = -20.25;
  map.px_per_cell = px_per_cell;
  map.um_per_px = um_per_px;
  const std::size_t cells = map.index(0, height);
  map.probability.assign(cells, 0);
  map.calibre_px.assign(cells, 0);
  map.seen.assign(cells, 100);
  return map;
}

/// Marks all cells within a distance of a line, all in cells.
inline void drawVessel(retina::VesselMap& map, Eigen::Vector2d from, Eigen::Vector2d to, double half_width,
                       std::uint8_t probability = 255)
{
  const Eigen::Vector2d along = to - from;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const Eigen::Vector2d cell(column, row);
      const double t = std::clamp((cell - from).dot(along) / std::max(along.squaredNorm(), 1e-9), 0.0, 1.0);
      if ((cell - from - t * along).norm() <= half_width) map.probability[map.index(column, row)] = probability;
    }
  }
}

/// A map of random size, scale, vessels and view.
inline retina::VesselMap randomMap(std::mt19937& random)
{
  const auto uniform = [&random](double lowest, double highest) {
    return std::uniform_real_distribution<double>(lowest, highest)(random);
  };
  const auto size = [&] { return static_cast<int>(uniform(30.0, 260.0)); };
  const int width = size(), height = size();
  retina::VesselMap map = emptyMap(width, height, uniform(0.5, 3.0), uniform(3.0, 12.0));
  map.origin_x = uniform(-500.0, 500.0);
  map.origin_y = uniform(-500.0, 500.0);
  const auto place = [&] { return Eigen::Vector2d(uniform(0.0, width), uniform(0.0, height)); };
  for (int vessels = static_cast<int>(uniform(0.0, 6.0)); vessels > 0; --vessels) {
    drawVessel(map, place(), place(), uniform(0.5, 4.0), static_cast<std::uint8_t>(uniform(100.0, 255.0)));
  }
  const Eigen::Vector2d middle = place();
  const double radius = uniform(0.3, 1.5) * std::max(width, height);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double distance = (Eigen::Vector2d(column, row) - middle).norm();
      map.seen[map.index(column, row)] =
          distance < radius ? std::uint8_t{200} : (distance < 1.2 * radius ? std::uint8_t{5} : std::uint8_t{0});
    }
  }
  return map;
}

/// From a place to the nearest cell's square that `isIn`, by looking at every cell of the map; map px.
template <class Test>
double bruteDistance_px(const retina::VesselMap& map, const Eigen::Vector2d& place_px, Test isIn)
{
  double nearest = HUGE_VAL;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (!isIn(map.index(column, row))) continue;
      const double half = map.px_per_cell / 2.0;
      const double left = map.origin_x + column * map.px_per_cell - half;
      const double top = map.origin_y + row * map.px_per_cell - half;
      const double dx = std::max({left - place_px.x(), place_px.x() - left - map.px_per_cell, 0.0});
      const double dy = std::max({top - place_px.y(), place_px.y() - top - map.px_per_cell, 0.0});
      nearest = std::min(nearest, std::hypot(dx, dy));
    }
  }
  return nearest;
}

}  // namespace eyeslam::support
