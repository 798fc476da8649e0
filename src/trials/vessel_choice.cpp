// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/vessel_choice.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "eyeslam/fixtures/centerline_index.h"
#include "eyeslam/fixtures/vessel_route.h"
#include "eyeslam/fixtures/vessel_walk.h"

namespace eyeslam::trials {

using fixtures::Vessel;
using Way = std::vector<Eigen::Vector2d>;

namespace {

constexpr int kBeyonds = 4;              // lengths beyond an end within which the way's middle is
constexpr double kFarthest_um = 2000.0;  // beyond an end that are told: the manipulator's reach
constexpr double kStraight = 0.77;       // cosine: 40 deg between what lies before and behind a point
constexpr double kLook_px = 15.0;        // over which a way's direction is taken
constexpr double kWidest = 2.5;          // of the least radius: no vessel of an eye is wider (facts, D4)
constexpr double kEven = 1.4;            // of a vessel's median radius
constexpr double kWider = 1.3;           // of a way's radius: not the way's own next stretch
constexpr double kBends = 3.0;           // radii from a wider vessel's edge; source: maps of rendered frames, by eye
constexpr std::size_t kStride = 5;       // points: crowding is no finer
constexpr double kCrowded = 1.5;         // times its length that a wholly crowded way loses

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

// A vessel and what it goes on into at both ends, straight on through whatever is there.
Way throughVessel(const fixtures::VesselNetwork& network, std::size_t vessel, double longest_px)
{
  const auto own = static_cast<double>(network.vessels[vessel].points.size());
  const double far_px = 2.0 * own + longest_px;  // points are at most 2 px apart
  Way way = fixtures::walk(network, vessel, far_px, fixtures::straightest, fixtures::Direction::backwards);
  way.erase(way.begin(), way.begin() + static_cast<std::ptrdiff_t>(network.vessels[vessel].points.size()));
  std::reverse(way.begin(), way.end());
  const Way onwards = fixtures::walk(network, vessel, far_px, fixtures::straightest);
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

bool isOn(const Way& way, const Eigen::Vector2d& place)
{
  return std::any_of(way.begin(), way.end(), [&place](const auto& p) { return (p - place).squaredNorm() < 4.0; });
}

// Share of the way beside which another vessel runs. What leaves it is on the way at its root, and soon apart.
double crowding(const Way& way, const fixtures::VesselNetwork& network, double apart_px)
{
  std::vector<Eigen::Vector2d> others;
  for (const Vessel& vessel : network.vessels) {
    if (isOn(way, vessel.points[vessel.points.size() / 2].position_px)) continue;
    for (std::size_t i = 0; i < vessel.points.size(); i += kStride) others.push_back(vessel.points[i].position_px);
  }
  std::size_t crowded = 0, looked = 0;
  for (std::size_t i = 0; i < way.size(); i += kStride, ++looked) {
    crowded += std::any_of(others.begin(), others.end(), [&](const Eigen::Vector2d& other) {
      return (other - way[i]).squaredNorm() < apart_px * apart_px;
    });
  }
  return static_cast<double>(crowded) / static_cast<double>(std::max<std::size_t>(looked, 1));
}

// The vessel that has both points next to each other, and where in it.
struct PlaceOn {
  const Vessel* vessel = nullptr;
  std::ptrdiff_t point = 0, step = 0;  // of the second one; from the first one to it
};

PlaceOn placeOf(const Eigen::Vector2d& before, const Eigen::Vector2d& at, const fixtures::VesselNetwork& network)
{
  for (const Vessel& vessel : network.vessels) {
    for (std::size_t i = 1; i < vessel.points.size(); ++i) {
      const Eigen::Vector2d &a = vessel.points[i - 1].position_px, &b = vessel.points[i].position_px;
      const auto index = static_cast<std::ptrdiff_t>(i);
      if (a == before && b == at) return {&vessel, index, 1};
      if (a == at && b == before) return {&vessel, index - 1, -1};
    }
  }
  return {};
}

// On from the end of a way, so far.
Way wayOn(const Way& way, double longest_px, const fixtures::VesselNetwork& network,
          const fixtures::CenterlineIndex& index)
{
  PlaceOn at = placeOf(way[way.size() - 2], way.back(), network);
  if (!at.vessel) return {};
  fixtures::VesselRoute route;
  route.lay(index, index.find(at.vessel->id));
  Way beyond;
  for (;;) {
    const auto points = static_cast<std::ptrdiff_t>(at.vessel->points.size());
    for (at.point += at.step; at.point >= 0 && at.point < points; at.point += at.step) {
      beyond.push_back(at.vessel->points[static_cast<std::size_t>(at.point)].position_px);
      if (static_cast<double>(beyond.size()) >= longest_px) return beyond;  // points are a px apart
    }
    const auto next = route.beyond({index.find(at.vessel->id), at.step > 0 ? 1 : 0});
    if (!next) return beyond;
    const int id = index.id(next->vessel);
    const auto vessel = std::find_if(network.vessels.begin(), network.vessels.end(),
                                     [id](const Vessel& other) { return other.id == id; });
    at = {&*vessel, next->end == 0 ? 0 : static_cast<std::ptrdiff_t>(vessel->points.size()) - 1,
          next->end == 0 ? 1 : -1};
  }
}

// With what lies beyond both ends.
ChosenVessel extended(const Way& path, double longest_px, const fixtures::VesselNetwork& network, double um_per_px)
{
  const fixtures::CenterlineIndex index(network.vessels, um_per_px);
  ChosenVessel chosen;
  chosen.centreline = wayOn({path.rbegin(), path.rend()}, longest_px, network, index);
  std::reverse(chosen.centreline.begin(), chosen.centreline.end());
  chosen.first = chosen.centreline.size();
  chosen.count = path.size();
  chosen.centreline.insert(chosen.centreline.end(), path.begin(), path.end());
  const Way after = wayOn(path, longest_px, network, index);
  chosen.centreline.insert(chosen.centreline.end(), after.begin(), after.end());
  return chosen;
}

}  // namespace

ChosenVessel vesselToTrace(const fixtures::VesselNetwork& network, const VesselWish& wish)
{
  const auto clear = clearPoints(network, wish);
  std::vector<double> radii_px;
  for (const Vessel& vessel : network.vessels) radii_px.push_back(radiusAt(vessel, 0.5));
  std::vector<Way> ways;
  std::vector<Run> runs;
  for (std::size_t i = 0; i < network.vessels.size(); ++i) {
    if (!isOneVessel(network.vessels[i], wish)) continue;
    ways.push_back(throughVessel(network, i, wish.longest_px + kBeyonds * wish.beyond_px));
    std::vector<bool> good = freeBothWays(ways.back(), crossings(ways.back(), radii_px[i], network, radii_px), wish);
    for (std::size_t k = 0; k < good.size(); ++k)
      good[k] = good[k] && clear.count({ways.back()[k].x(), ways.back()[k].y()}) > 0;
    addRuns(ways.back(), ways.size() - 1, good, wish, runs);
  }
  // Crowding only shortens, and takes longer to find out.
  std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.length > b.length; });
  const Run* best = nullptr;
  double best_worth = 0.0;
  const auto beyond = static_cast<std::ptrdiff_t>(wish.beyond_px), farthest = kBeyonds * beyond;
  for (const Run& run : runs) {
    if (run.length <= best_worth) break;
    const auto begin = ways[run.way].begin() + static_cast<std::ptrdiff_t>(run.first);
    const auto end = begin + static_cast<std::ptrdiff_t>(run.count);
    const double worth =
        run.length * (1.0 - kCrowded * crowding({begin - beyond, end + beyond}, network, wish.apart_px));
    if (worth <= best_worth) continue;
    best_worth = worth;
    best = &run;
  }
  if (!best) return {};
  const Way& way = ways[best->way];
  const auto begin = way.begin() + static_cast<std::ptrdiff_t>(best->first);
  const auto end = begin + static_cast<std::ptrdiff_t>(best->count);
  ChosenVessel chosen = extended({begin, end}, kFarthest_um / wish.um_per_px, network, wish.um_per_px);
  const auto from = begin - std::min(farthest, begin - way.begin()), to = end + std::min(farthest, way.end() - end);
  chosen.middle = *(from + (to - from) / 2);
  return chosen;
}

}  // namespace eyeslam::trials
