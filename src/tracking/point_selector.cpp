// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/point_selector.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::tracking {

namespace {

constexpr int kSquares = 64;  // along a side; what lies beyond belongs to the last square

std::size_t square(const VesselPoint& point, double square_px)
{
  const auto clamped = [&](float at) {
    return static_cast<std::size_t>(std::clamp(std::floor(at / square_px), 0.0, kSquares - 1.0));
  };
  return clamped(point.y) * kSquares + clamped(point.x);
}

}  // namespace

PointSelector::PointSelector(const PointSelectorOptions& options) : options_(options), squares_(kSquares * kSquares)
{
  restart();
}

void PointSelector::restart() { random_.seed(static_cast<std::mt19937::result_type>(options_.seed)); }

void PointSelector::choose(const VesselPoints& points, const Eigen::Vector2d& centre, ScanPoints& chosen)
{
  choose(points, centre, options_.most_points, chosen);
}

void PointSelector::choose(const VesselPoints& points, const Eigen::Vector2d& centre, int most_points,
                           ScanPoints& chosen)
{
  shuffle(points);
  sortByRound(points);
  const std::size_t count = std::min(order_.size(), static_cast<std::size_t>(std::max(0, most_points)));
  chosen.clear();
  for (std::size_t n = 0; n < count; ++n) {
    const VesselPoint& point = points[by_round_[n]];
    chosen.emplace_back(static_cast<float>(point.x - centre.x()), static_cast<float>(point.y - centre.y()));
  }
}

void PointSelector::shuffle(const VesselPoints& points)
{
  order_.clear();
  for (std::size_t n = 0; n < points.size(); ++n) {
    if (std::isfinite(points[n].x) && std::isfinite(points[n].y)) order_.push_back(static_cast<std::uint32_t>(n));
  }
  // Not std::shuffle: its draws differ between libraries, and the same seed must choose the same points everywhere.
  for (std::size_t left = order_.size(); left > 1; --left) {
    const auto drawn = static_cast<std::size_t>((std::uint64_t{random_()} * left) >> 32);
    std::swap(order_[left - 1], order_[drawn]);
  }
}

// A point's round is the number of shuffled points before it in its square.
void PointSelector::sortByRound(const VesselPoints& points)
{
  std::fill(squares_.begin(), squares_.end(), 0U);
  round_.resize(order_.size());
  starts_.assign(order_.size() + 1, 0U);
  for (std::size_t n = 0; n < order_.size(); ++n) {
    round_[n] = squares_[square(points[order_[n]], options_.square_px)]++;
    ++starts_[round_[n] + 1];
  }
  for (std::size_t r = 1; r < starts_.size(); ++r) starts_[r] += starts_[r - 1];
  by_round_.resize(order_.size());
  for (std::size_t n = 0; n < order_.size(); ++n) by_round_[starts_[round_[n]]++] = order_[n];
}

}  // namespace eyeslam::tracking
