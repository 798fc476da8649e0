// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/occupancy_map.h"
#include "eyeslam/tracking/vessel_point.h"

namespace eyeslam::support {

/// Random vessels as polylines that wander over a square of the map, one point every pixel, 600 px at most; centred map
/// px.
inline tracking::ScanPoints randomVessels(std::mt19937& random, int vessels, double side_px)
{
  constexpr int kLongest_px = 600;
  std::uniform_real_distribution<double> place(-side_px / 2, side_px / 2), angle(-M_PI, M_PI);
  std::normal_distribution<double> bend(0.0, 0.03);
  tracking::ScanPoints points;
  for (int vessel = 0; vessel < vessels; ++vessel) {
    Eigen::Vector2d at(place(random), place(random));
    double direction = angle(random), turning = 0.0;
    for (int step = 0; step < kLongest_px && at.cwiseAbs().maxCoeff() <= side_px / 2; ++step) {
      points.emplace_back(at.cast<float>());
      turning = 0.9 * turning + 0.3 * bend(random);
      direction += turning;
      at += Eigen::Vector2d(std::cos(direction), std::sin(direction));
    }
  }
  return points;
}

/// What a view of `width` x `height` px sees of them: at most `most` of the points inside, displaced by `noise_px`, and
/// a share of `clutter` points anywhere; centred frame px.
inline tracking::ScanPoints seenFrom(const retina::Pose2& map_T_frame, const tracking::ScanPoints& vessels, int width,
                                     int height, int most, double noise_px, double clutter, std::mt19937& random)
{
  const retina::Pose2 frame_T_map = map_T_frame.inverse();
  tracking::ScanPoints inside;
  for (const Eigen::Vector2f& vessel : vessels) {
    const Eigen::Vector2d point = frame_T_map * vessel.cast<double>();
    if (std::abs(point.x()) < width / 2.0 && std::abs(point.y()) < height / 2.0)
      inside.emplace_back(point.cast<float>());
  }
  std::shuffle(inside.begin(), inside.end(), random);
  inside.resize(std::min(inside.size(), static_cast<std::size_t>(most)));
  std::normal_distribution<float> unit(0.0F, 1.0F);  // scaled, because a deviation of 0 is not allowed
  const auto noise = [&](std::mt19937& engine) { return static_cast<float>(noise_px) * unit(engine); };
  std::uniform_real_distribution<float> share(0.0F, 1.0F), across(-0.5F, 0.5F);
  for (Eigen::Vector2f& point : inside) {
    point += Eigen::Vector2f(noise(random), noise(random));
    if (share(random) < clutter) {
      point = Eigen::Vector2f(across(random) * static_cast<float>(width), across(random) * static_cast<float>(height));
    }
  }
  return inside;
}

/// Adds points to a map so often that their cells saturate.
inline void saturate(tracking::OccupancyMap& map, const tracking::ScanPoints& points)
{
  for (int i = 0; i < 5; ++i) map.add(points, {});
}

}  // namespace eyeslam::support
