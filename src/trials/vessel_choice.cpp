// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/vessel_choice.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "eyeslam/fixtures/centerline_index.h"
#include "eyeslam/fixtures/vessel_route.h"

namespace eyeslam::trials {

using fixtures::Vessel;
using Way = std::vector<Eigen::Vector2d>;

namespace {

constexpr int kBeyonds = 4;         // lengths beyond an end within which the way's middle is
constexpr double kStraight = 0.77;  // cosine: 40 deg between what lies before and behind a point
constexpr double kLook_px = 15.0;   // over which a way's direction is taken
constexpr double kWidest = 2.5;     // of the least radius: no vessel of an eye is wider (facts, D4)
constexpr double kEven = 1.4;       // of a vessel's median radius
constexpr double kWider = 1.3;      // of a way's radius: not the way's own next stretch
constexpr double kBends = 3.0;      // radii from a wider vessel's edge; source: maps of rendered frames, by eye
constexpr std::size_t kStride = 5;  // points: crowding is no finer
constexpr double kCrowded = 1.5;    // times its length that a wholly crowded way loses

double radiusAt(const Vessel& vessel, double quantile)
{
  std::vector<double> radii;
  radii.reserve(vessel.points.size());
  for (const fixtures::CenterlinePoint& point : vessel.points) radii.push_back(point.radius_px);
  const auto rank = static_cast<std::ptrdiff_t>(quantile * static_cast<double>(radii.size() - 1));
  std::nth_element(radii.begin(), radii.begin() + rank, radii.end());
  return radii[static_cast<std::size_t>(rank)];
}

// Where two vessels lie upon each other the picture has one that is too wide, in places.
bool isOneVessel(const Vessel& vessel, const VesselWish& wish)
{
  const double radius = radiusAt(vessel, 0.5);
  return radius >= wish.radius_px && radius <= kWidest * wish.radius_px && radiusAt(vessel, 0.95) <= kEven * radius;
}

// From an end of a vessel into what its route goes on into, so far; points are a px apart.
Way routeBeyond(fixtures::VesselEnd from, const fixtures::VesselRoute& route, const fixtures::VesselNetwork& network,
                const fixtures::CenterlineIndex& index, double longest_px)
{
  Way way;
  for (auto next = route.beyond(from); next; next = route.beyond({next->vessel, 1 - next->end})) {
    const int id = index.id(next->vessel);
    const Vessel& vessel = *std::find_if(network.vessels.begin(), network.vessels.end(),
                                         [id](const Vessel& other) { return other.id == id; });
    for (std::size_t i = 0; i < vessel.points.size(); ++i) {
      const std::size_t point = next->end == 0 ? i : vessel.points.size() - 1 - i;
      way.push_back(vessel.points[point].position_px);
      if (static_cast<double>(way.size()) >= longest_px) return way;
    }
  }
  return way;
}

// A vessel and what it goes on into at both ends, as a fixture goes that keeps to it.
Way throughVessel(const Vessel& vessel, const fixtures::VesselNetwork& network, const fixtures::CenterlineIndex& index,
                  double longest_px)
{
  const int number = index.find(vessel.id);
  if (number < 0) return {};  // without length
  fixtures::VesselRoute route;
  route.lay(index, number);
  Way way = routeBeyond({number, 0}, route, network, index, longest_px);
  std::reverse(way.begin(), way.end());
  for (const fixtures::CenterlinePoint& point : vessel.points) way.push_back(point.position_px);
  const Way onwards = routeBeyond({number, 1}, route, network, index, longest_px);
  way.insert(way.end(), onwards.begin(), onwards.end());
  return way;
}

// The points of vessels that are wide enough and one each.
std::set<std::pair<double, double>> clearPoints(const fixtures::VesselNetwork& network, const VesselWish& wish)
{
  std::set<std::pair<double, double>> points;
  for (const Vessel& vessel : network.vessels) {
    if (!isOneVessel(vessel, wish)) continue;
    for (const fixtures::CenterlinePoint& point : vessel.points)
      points.emplace(point.position_px.x(), point.position_px.y());
  }
  return points;
}

bool isSmoothAt(const Way& way, std::size_t i)
{
  const auto look = static_cast<std::size_t>(kLook_px);
  if (i < look || i + look >= way.size()) return true;
  return (way[i] - way[i - look]).normalized().dot((way[i + look] - way[i]).normalized()) >= kStraight;
}

// Where a wider vessel lies across the way, or so near to it that a map bends the way into it.
std::vector<bool> crossings(const Way& way, double radius_px, const fixtures::VesselNetwork& network,
                            const std::vector<double>& radii_px)
{
  std::vector<bool> crossed(way.size());
  const double near_px = kBends * radius_px;
  const double near_sq = near_px * near_px;
  for (std::size_t v = 0; v < network.vessels.size(); ++v) {
    if (radii_px[v] < kWider * radius_px) continue;
    const Vessel& vessel = network.vessels[v];
    for (std::size_t i = 0; i < vessel.points.size(); i += kStride) {
      const fixtures::CenterlinePoint& other = vessel.points[i];
      const double reach_sq = near_sq + other.radius_px * (2.0 * near_px + other.radius_px);
      for (std::size_t k = 0; k < way.size(); k += kStride)
        if ((way[k] - other.position_px).squaredNorm() < reach_sq) crossed[k] = true;
    }
  }
  for (std::size_t k = 0; k < way.size(); ++k) crossed[k] = crossed[k / kStride * kStride];
  return crossed;
}

// Where for `beyond_px` both ways nothing is in the way: no bend, no wider vessel, no place to keep away from.
std::vector<bool> freeBothWays(const Way& way, const std::vector<bool>& crossed, const VesselWish& wish)
{
  const auto beyond = static_cast<std::size_t>(wish.beyond_px);  // points are a px apart
  std::vector<bool> result(way.size());
  std::size_t free = 0;  // of the points before, without a gap
  for (std::size_t i = 0; i < way.size(); ++i) {
    const bool blocked = crossed[i] || !isSmoothAt(way, i) || (wish.excluded && wish.excluded(way[i]));
    free = blocked ? 0 : free + 1;
    if (free > 2 * beyond) result[i - beyond] = true;
  }
  return result;
}

// A run of good points within the area.
struct Run {
  std::size_t way = 0, first = 0, count = 0;
  double length = 0.0;
};

void addRuns(const Way& way, std::size_t number, const std::vector<bool>& good, const VesselWish& wish,
             std::vector<Run>& runs)
{
  Run run{number};
  const auto end = [&](std::size_t next) {
    if (run.count > 1) runs.push_back(run);
    run = {number, next};
  };
  for (std::size_t i = 0; i < way.size(); ++i) {
    const double step = run.count > 0 ? (way[i] - way[i - 1]).norm() : 0.0;
    if (!good[i] || !wish.area_px.contains(way[i]) || run.length + step > wish.longest_px) {
      end(i + 1);
      continue;
    }
    ++run.count;
    run.length += step;
  }
  end(way.size());
}

// The run and what the way has beyond both its ends, as many points at most.
Way around(const Way& way, const Run& run, std::size_t beyond)
{
  const std::size_t begin = run.first - std::min(run.first, beyond);
  const std::size_t end = std::min(way.size(), run.first + run.count + beyond);
  return {way.begin() + static_cast<std::ptrdiff_t>(begin), way.begin() + static_cast<std::ptrdiff_t>(end)};
}

bool isOn(const Way& way, const Eigen::Vector2d& place)
{
  return std::any_of(way.begin(), way.end(), [&place](const auto& p) { return (p - place).squaredNorm() < 4.0; });
}

// Points of other vessels. What leaves the way is on it at its root, and soon apart.
std::vector<Eigen::Vector2d> othersThan(const Way& way, const fixtures::VesselNetwork& network)
{
  std::vector<Eigen::Vector2d> others;
  for (const Vessel& vessel : network.vessels) {
    if (isOn(way, vessel.points[vessel.points.size() / 2].position_px)) continue;
    for (std::size_t i = 0; i < vessel.points.size(); i += kStride) others.push_back(vessel.points[i].position_px);
  }
  return others;
}

// Share of the way beside which another vessel runs.
double crowding(const Way& way, const fixtures::VesselNetwork& network, double apart_px)
{
  const std::vector<Eigen::Vector2d> others = othersThan(way, network);
  std::size_t crowded = 0, looked = 0;
  for (std::size_t i = 0; i < way.size(); i += kStride, ++looked) {
    crowded += std::any_of(others.begin(), others.end(), [&](const Eigen::Vector2d& other) {
      return (other - way[i]).squaredNorm() < apart_px * apart_px;
    });
  }
  return static_cast<double>(crowded) / static_cast<double>(std::max<std::size_t>(looked, 1));
}

// Where a part of a way is farthest from others; its middle where there are none.
std::size_t clearestOf(const Way& path, const std::vector<Eigen::Vector2d>& others)
{
  std::size_t clearest = path.size() / 2;
  double farthest_sq = 0.0;
  for (std::size_t i = 0; i < path.size() && !others.empty(); ++i) {
    double nearest_sq = HUGE_VAL;
    for (const Eigen::Vector2d& other : others) nearest_sq = std::min(nearest_sq, (other - path[i]).squaredNorm());
    if (nearest_sq <= farthest_sq) continue;
    farthest_sq = nearest_sq;
    clearest = i;
  }
  return clearest;
}

}  // namespace

ChosenVessel vesselToTrace(const fixtures::VesselNetwork& network, const VesselWish& wish)
{
  const fixtures::CenterlineIndex index(network.vessels, wish.um_per_px);
  const auto clear = clearPoints(network, wish);
  std::vector<double> radii_px;
  for (const Vessel& vessel : network.vessels) radii_px.push_back(radiusAt(vessel, 0.5));
  std::vector<Way> ways;
  std::vector<Run> runs;
  for (std::size_t i = 0; i < network.vessels.size(); ++i) {
    if (!isOneVessel(network.vessels[i], wish)) continue;
    ways.push_back(throughVessel(network.vessels[i], network, index, wish.longest_px + kBeyonds * wish.beyond_px));
    std::vector<bool> good = freeBothWays(ways.back(), crossings(ways.back(), radii_px[i], network, radii_px), wish);
    for (std::size_t k = 0; k < good.size(); ++k)
      good[k] = good[k] && clear.count({ways.back()[k].x(), ways.back()[k].y()}) > 0;
    addRuns(ways.back(), ways.size() - 1, good, wish, runs);
  }
  // Crowding only shortens, and takes longer to find out.
  std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.length > b.length; });
  const Run* best = nullptr;
  double best_worth = 0.0;
  const auto beyond = static_cast<std::size_t>(wish.beyond_px);
  for (const Run& run : runs) {
    if (run.length <= best_worth) break;
    const double worth =
        run.length * (1.0 - kCrowded * crowding(around(ways[run.way], run, beyond), network, wish.apart_px));
    if (worth <= best_worth) continue;
    best_worth = worth;
    best = &run;
  }
  if (!best) return {};
  const Way& way = ways[best->way];
  const Way path = around(way, *best, 0), near = around(way, *best, kBeyonds * beyond);
  return {path, around(way, *best, beyond), clearestOf(path, othersThan(way, network)), near[near.size() / 2]};
}

}  // namespace eyeslam::trials
