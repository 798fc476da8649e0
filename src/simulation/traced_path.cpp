// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/traced_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

constexpr double kLength = 3e-3;

}  // namespace

TracedPath::TracedPath(std::vector<Eigen::Vector3d> points, double speed) : points_(std::move(points)), speed_(speed)
{
  arc_.reserve(points_.size());
  double arc = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (i > 0) arc += (points_[i] - points_[i - 1]).norm();
    arc_.push_back(arc);
  }
  if (!(arc > 0.0) || !(speed > 0.0)) throw std::invalid_argument("a traced path needs a length and a speed above 0");
}

PathTarget TracedPath::at(double t) const
{
  const double travelled = std::fmod(std::max(0.0, t) * speed_, 2.0 * length());
  const bool forth = travelled < length();
  const double s = forth ? travelled : 2.0 * length() - travelled;
  const auto above = std::upper_bound(arc_.begin(), arc_.end() - 1, s);
  const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, above - arc_.begin()));
  const Eigen::Vector3d side = points_[i] - points_[i - 1];
  const double span = arc_[i] - arc_[i - 1];
  const double part = span > 0.0 ? (s - arc_[i - 1]) / span : 0.0;
  return {points_[i - 1] + part * side, (forth ? speed_ : -speed_) * side.normalized()};
}

std::vector<Eigen::Vector3d> sineVessel(double a, double b, double step)
{
  std::vector<Eigen::Vector3d> points;
  const int count = static_cast<int>(std::lround(kLength / step));
  points.reserve(static_cast<std::size_t>(count) + 1);
  for (int i = 0; i <= count; ++i) {
    const double x = kLength * i / count;
    points.emplace_back(x, 300e-6 * std::sin(kTwoPi * x / 3e-3 + a) + 50e-6 * std::sin(kTwoPi * x / 1.2e-3 + b), 0.0);
  }
  return points;
}

}  // namespace eyeslam::simulation
