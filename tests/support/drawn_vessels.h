// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::support {

/// A vessel map that is drawn: tubes whose walls lie exactly where they are said to, to within the 8 bits of a cell.
class DrawnVessels {
 public:
  DrawnVessels(int width, int height, double origin_x = 0.0, double origin_y = 0.0, double px_per_cell = 1.0)
  {
    map_.width = width;
    map_.height = height;
    map_.origin_x = origin_x;
    map_.origin_y = origin_y;
    map_.px_per_cell = px_per_cell;
    const auto cells = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    map_.probability.assign(cells, 0);
    map_.calibre_px.assign(cells, 0);
    map_.seen.assign(cells, 255);
  }

  const retina::VesselMap& map() const { return map_; }
  retina::VesselMap& map() { return map_; }

  /// A tube along a polyline; map px.
  DrawnVessels& tube(const std::vector<Eigen::Vector2d>& line, double radius_px)
  {
    return paint([&](const Eigen::Vector2d& at) { return distance(line, at) - radius_px; }, bounds(line, radius_px));
  }

  DrawnVessels& disc(const Eigen::Vector2d& centre, double radius_px) { return tube({centre, centre}, radius_px); }

  /// A disc without vessel.
  DrawnVessels& hole(const Eigen::Vector2d& centre, double radius_px)
  {
    forCells(bounds({centre}, radius_px), [&](std::uint8_t& cell, const Eigen::Vector2d& at) {
      if ((at - centre).norm() <= radius_px) cell = 0;
    });
    return *this;
  }

  /// Every cell of a stretch of the map at random; `share` of them vessel.
  DrawnVessels& noise(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double share, std::mt19937_64& random)
  {
    std::bernoulli_distribution vessel(share);
    forCells({from, to}, [&](std::uint8_t& cell, const Eigen::Vector2d&) { cell = vessel(random) ? 255 : 0; });
    return *this;
  }

 private:
  struct Bounds {
    Eigen::Vector2d lowest, highest;
  };

  static Bounds bounds(const std::vector<Eigen::Vector2d>& line, double radius_px)
  {
    Bounds result{line[0], line[0]};
    for (const Eigen::Vector2d& point : line) {
      result.lowest = result.lowest.cwiseMin(point);
      result.highest = result.highest.cwiseMax(point);
    }
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(radius_px + 3.0);
    return {result.lowest - margin, result.highest + margin};
  }

  static double distance(const std::vector<Eigen::Vector2d>& line, const Eigen::Vector2d& at)
  {
    double nearest = (line[0] - at).norm();
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Eigen::Vector2d step = line[i] - line[i - 1];
      const double length2 = step.squaredNorm();
      const double t = length2 > 0.0 ? std::clamp((at - line[i - 1]).dot(step) / length2, 0.0, 1.0) : 0.0;
      nearest = std::min(nearest, (line[i - 1] + t * step - at).norm());
    }
    return nearest;
  }

  template <class Visit>
  void forCells(const Bounds& bounds, Visit visit)
  {
    const auto cell = [this](double px, double origin, int count) {
      return static_cast<int>(std::clamp(std::floor((px - origin) / map_.px_per_cell), 0.0, count - 1.0));
    };
    for (int r = cell(bounds.lowest.y(), map_.origin_y, map_.height);
         r <= cell(bounds.highest.y(), map_.origin_y, map_.height); ++r) {
      for (int c = cell(bounds.lowest.x(), map_.origin_x, map_.width);
           c <= cell(bounds.highest.x(), map_.origin_x, map_.width); ++c) {
        visit(map_.probability[map_.index(c, r)],
              Eigen::Vector2d(map_.origin_x + c * map_.px_per_cell, map_.origin_y + r * map_.px_per_cell));
      }
    }
  }

  // The threshold, 128, lies on the wall; a cell to either side it is certain.
  template <class Signed>
  DrawnVessels& paint(Signed outside_px, const Bounds& bounds)
  {
    forCells(bounds, [&](std::uint8_t& cell, const Eigen::Vector2d& at) {
      const double level = 128.0 - 128.0 * outside_px(at) / map_.px_per_cell;
      cell = std::max(cell, static_cast<std::uint8_t>(std::clamp(level, 0.0, 255.0)));
    });
    return *this;
  }

  retina::VesselMap map_;
};

/// A bent vessel: from a point on, with a heading that drifts.
inline std::vector<Eigen::Vector2d> bentLine(Eigen::Vector2d from, double heading, double length_px, double bend,
                                             std::mt19937_64& random)
{
  std::normal_distribution<double> turn(0.0, bend);
  std::vector<Eigen::Vector2d> line{from};
  double turning = 0.0;
  for (double s = 0.0; s < length_px; s += 2.0) {
    turning = 0.9 * turning + turn(random);
    heading += turning;
    from += 2.0 * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    line.push_back(from);
  }
  return line;
}

/// A tree of vessels across a map, its branches thinner than their parents.
inline void drawTree(DrawnVessels& drawn, std::mt19937_64& random)
{
  const retina::VesselMap& map = drawn.map();
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const Eigen::Vector2d size(map.width * map.px_per_cell, map.height * map.px_per_cell);
  const Eigen::Vector2d origin(map.origin_x, map.origin_y);
  for (int trunk = 0; trunk < 3; ++trunk) {
    const Eigen::Vector2d from = origin + Eigen::Vector2d(0.1 * size.x(), (0.2 + 0.3 * trunk) * size.y());
    const auto line = bentLine(from, 0.6 * (unit(random) - 0.5), 0.8 * size.x(), 0.004, random);
    drawn.tube(line, 4.0 + 4.0 * unit(random));
    for (int branch = 0; branch < 3; ++branch) {
      const std::size_t at = static_cast<std::size_t>((0.15 + 0.7 * unit(random)) * static_cast<double>(line.size()));
      const double side = unit(random) < 0.5 ? 1.0 : -1.0;
      drawn.tube(bentLine(line[at], side * (0.7 + 0.8 * unit(random)), 30.0 + 60.0 * unit(random), 0.01, random),
                 1.5 + 1.5 * unit(random));
    }
  }
}

}  // namespace eyeslam::support
