// SPDX-License-Identifier: GPL-3.0-or-later
#include "guidance/vessel_walk.h"

#include <algorithm>
#include <set>
#include <utility>

namespace eyeslam::apps {

namespace {

using fixtures::Vessel;

// A vessel and the way it is walked.
struct Leg {
  std::size_t vessel;
  bool backwards;
};

const Eigen::Vector2d& point(const Vessel& vessel, const Leg& leg, std::size_t i)
{
  const std::size_t at = leg.backwards ? vessel.points.size() - 1 - i : i;
  return vessel.points[at].position_px;
}

// The way that a leg begins with, over a few points so that the fit around the junction does not decide.
Eigen::Vector2d heading(const Vessel& vessel, const Leg& leg)
{
  constexpr std::size_t kLook = 8;
  const std::size_t last = std::min(vessel.points.size() - 1, kLook);
  return (point(vessel, leg, last) - point(vessel, leg, 0)).normalized();
}

Leg reversed(const Leg& leg) { return {leg.vessel, !leg.backwards}; }

int farEnd(const Vessel& vessel, const Leg& leg) { return vessel.ends[leg.backwards ? 0 : 1]; }

std::vector<Leg> branchesAt(const fixtures::VesselNetwork& network, int junction, const std::set<std::size_t>& walked)
{
  std::vector<Leg> branches;
  for (std::size_t i = 0; i < network.vessels.size(); ++i) {
    if (walked.count(i) > 0) continue;
    for (const std::size_t end : {0U, 1U}) {
      if (network.vessels[i].ends[end] == junction) branches.push_back({i, end == 1});
    }
  }
  return branches;
}

// Appends a leg as far as the length allows; the length that is left.
double append(const Vessel& vessel, const Leg& leg, double left_px, std::vector<Eigen::Vector2d>& way)
{
  for (std::size_t i = 0; i < vessel.points.size() && left_px > 0.0; ++i) {
    const Eigen::Vector2d& next = point(vessel, leg, i);
    if (!way.empty()) {
      if (next == way.back()) continue;  // the junction that two legs share
      left_px -= (next - way.back()).norm();
    }
    way.push_back(next);
  }
  return left_px;
}

double lengthOf(const std::vector<Eigen::Vector2d>& way)
{
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
  return length;
}

// The longest run of points inside a circle.
std::vector<Eigen::Vector2d> runWithin(const std::vector<Eigen::Vector2d>& way, const Eigen::Vector2d& middle,
                                       double radius)
{
  std::vector<Eigen::Vector2d> best, run;
  for (const Eigen::Vector2d& at : way) {
    if ((at - middle).norm() <= radius) {
      run.push_back(at);
    } else {
      if (run.size() > best.size()) best = run;
      run.clear();
    }
  }
  return run.size() > best.size() ? run : best;
}

std::vector<Eigen::Vector2d> firstPart(std::vector<Eigen::Vector2d> way, double longest_px)
{
  std::size_t kept = 1;
  for (double left = longest_px; kept < way.size() && left > 0.0; ++kept) left -= (way[kept] - way[kept - 1]).norm();
  way.resize(kept);
  return way;
}

}  // namespace

std::vector<Eigen::Vector2d> walk(const fixtures::VesselNetwork& network, std::size_t first, double longest_px,
                                  const BranchChoice& choose)
{
  std::vector<Eigen::Vector2d> way;
  std::set<std::size_t> walked;
  Leg leg{first, false};
  double left = longest_px;
  for (;;) {
    const Vessel& vessel = network.vessels[leg.vessel];
    left = append(vessel, leg, left, way);
    walked.insert(leg.vessel);
    const int junction = farEnd(vessel, leg);
    if (left <= 0.0 || junction == Vessel::kNoJunction) return way;
    const std::vector<Leg> branches = branchesAt(network, junction, walked);
    if (branches.empty()) return way;
    std::vector<Eigen::Vector2d> headings;
    headings.reserve(branches.size());
    for (const Leg& branch : branches) headings.push_back(heading(network.vessels[branch.vessel], branch));
    leg = branches[choose(-heading(vessel, reversed(leg)), headings)];
  }
}

std::size_t straightest(const Eigen::Vector2d& heading, const std::vector<Eigen::Vector2d>& branches)
{
  const auto turns_less = [&](const auto& a, const auto& b) { return a.dot(heading) < b.dot(heading); };
  return static_cast<std::size_t>(std::max_element(branches.begin(), branches.end(), turns_less) - branches.begin());
}

std::vector<Eigen::Vector2d> longestWay(const fixtures::VesselNetwork& network, const Eigen::Vector2d& middle_px,
                                        double radius_px, double longest_px)
{
  constexpr double kFar_px = 1e5;
  constexpr double kCentral = 0.2;  // px of length that a px nearer to the middle is worth
  std::vector<Eigen::Vector2d> best;
  double best_worth = -radius_px;
  for (std::size_t first = 0; first < network.vessels.size(); ++first) {
    const auto run = runWithin(walk(network, first, kFar_px, straightest), middle_px, radius_px);
    if (run.size() < 2) continue;
    auto way = firstPart(run, longest_px);
    const double worth = lengthOf(way) - kCentral * (way[way.size() / 2] - middle_px).norm();
    if (worth <= best_worth) continue;
    best_worth = worth;
    best = std::move(way);
  }
  return best;
}

}  // namespace eyeslam::apps
