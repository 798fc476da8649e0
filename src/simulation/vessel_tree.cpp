// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/vessel_tree.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/random.h"

namespace eyeslam::simulation {

namespace {

using Eigen::Vector2d;

constexpr double kStep_um = 30.0;
constexpr int kMostVessels = 4000;

Vector2d heading(double angle) { return {std::cos(angle), std::sin(angle)}; }

double turnTowards(double angle, const Vector2d& direction, double share)
{
  const double wanted = std::atan2(direction.y(), direction.x());
  return angle + share * std::remainder(wanted - angle, kTwoPi);
}

// Which vessel came first to a place, per kind.
class Territory {
 public:
  Territory(const Vector2d& extent, double cell_um)
      : cell_(cell_um),
        columns_(static_cast<int>(extent.x() / cell_um) + 1),
        rows_(static_cast<int>(extent.y() / cell_um) + 1),
        owners_{std::vector<int>(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1),
                std::vector<int>(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1)}
  {}

  bool contains(const Vector2d& place) const
  {
    return place.x() >= 0.0 && place.y() >= 0.0 && place.x() < columns_ * cell_ && place.y() < rows_ * cell_;
  }
  int& owner(Vessel::Kind kind, const Vector2d& place)
  {
    const auto column = static_cast<std::size_t>(place.x() / cell_);
    const auto row = static_cast<std::size_t>(place.y() / cell_);
    return owners_[kind == Vessel::Kind::vein ? 1 : 0][row * static_cast<std::size_t>(columns_) + column];
  }

 private:
  double cell_;
  int columns_, rows_;
  std::vector<int> owners_[2];
};

// The growing end of a vessel.
struct Sprout {
  Vessel::Kind kind;
  Vector2d place;
  double angle;
  double radius;
  int parent;
  std::vector<Vector2d> guide;  // a trunk's way; empty = a free branch
  bool to_fovea;
};

class Growth {
 public:
  Growth(const RetinaPlan& plan, const VesselTreeOptions& options, std::uint64_t seed)
      : plan_(plan), options_(options), random_(seed, 21), territory_(plan.extent, options.spacing_um)
  {}

  std::vector<Vessel> run()
  {
    plantTrunks();
    // First come, first served: trunks are in front, so that twigs make way for them.
    while (!sprouts_.empty() && vessels_.size() < kMostVessels) {
      const Sprout sprout = sprouts_.front();
      sprouts_.pop_front();
      grow(sprout);
    }
    return std::move(vessels_);
  }

 private:
  // The way of an arcade in mm: temporal of the disc, upwards; mirrored for the other quadrants.
  void plantTrunks()
  {
    const double temporal = plan_.fovea.x() > plan_.disc.x() ? 1.0 : -1.0;
    const std::vector<Vector2d> arcade = {{0.25, -0.9}, {1.1, -2.1}, {2.9, -3.0},
                                          {5.2, -3.2},  {7.6, -2.5}, {10.0, -1.6}};
    const std::vector<Vector2d> nasal = {{-0.5, -0.8}, {-1.9, -1.9}, {-3.8, -2.8}, {-6.5, -4.2}};
    for (const double up : {1.0, -1.0}) {
      for (const Vessel::Kind kind : {Vessel::Kind::vein, Vessel::Kind::artery}) {
        plant(kind, arcade, {temporal, up}, 1.0);
        plant(kind, nasal, {temporal, up}, 0.78);
      }
    }
    // Small vessels straight to the macula.
    for (int i = 0; i < 7; ++i) {
      const double angle =
          std::atan2(plan_.fovea.y() - plan_.disc.y(), plan_.fovea.x() - plan_.disc.x()) + random_.uniform(-0.7, 0.7);
      const auto kind = i % 2 ? Vessel::Kind::vein : Vessel::Kind::artery;
      sprouts_.push_back({kind,
                          plan_.disc + 0.15 * plan_.disc_radius * heading(angle),
                          angle,
                          random_.uniform(15.0, 27.0),
                          -1,
                          {},
                          true});
    }
  }

  void plant(Vessel::Kind kind, const std::vector<Vector2d>& way_mm, const Vector2d& mirror, double size)
  {
    Sprout sprout{kind, {}, 0.0, 0.0, -1, {}, false};
    const double widen = (kind == Vessel::Kind::vein ? 1.0 : 0.9) * random_.uniform(0.9, 1.12);
    for (const Vector2d& mm : way_mm) {
      const Vector2d jitter(random_.normal(), random_.normal());
      sprout.guide.push_back(plan_.disc + 1000.0 * widen * mm.cwiseProduct(mirror) + 110.0 * jitter);
    }
    // Arteries and veins leave through the cup, beside each other.
    sprout.place = plan_.disc + Vector2d(-0.25 * mirror.x() + 0.1 * random_.normal(), 0.1 * random_.normal()) *
                                    plan_.disc_radius * 0.6;
    const Vector2d first = sprout.guide.front() - sprout.place;
    sprout.angle = std::atan2(first.y(), first.x()) + 0.2 * random_.normal();
    sprout.radius =
        0.5 * size * (kind == Vessel::Kind::vein ? options_.vein_um : options_.artery_um) * random_.uniform(0.88, 1.08);
    sprouts_.push_back(sprout);
  }

  void grow(Sprout sprout)
  {
    const int id = static_cast<int>(vessels_.size());
    Vessel vessel;
    vessel.kind = sprout.kind;
    double winding = 0.0;
    double until_branch = branchDistance(sprout.radius) * random_.uniform(0.3, 1.0);
    std::size_t next = 0;
    for (double length = 0.0;; length += kStep_um) {
      vessel.nodes.push_back({sprout.place, sprout.radius});
      const bool young = length < 1.6 * options_.spacing_um;
      if (!mayGrow(sprout, id, young)) break;
      territory_.owner(sprout.kind, sprout.place) = id;
      if (length > until_branch && outsideDisc(sprout.place)) {
        if (!branch(sprout, id)) break;
        until_branch = length + branchDistance(sprout.radius) * random_.uniform(0.4, 1.6);
      }
      sprout.radius *= 0.9992;  // what unseen twigs take
      // It winds about its course, and the course itself drifts a little: no loops.
      winding = 0.93 * winding + options_.tortuosity * random_.normal();
      sprout.angle = steered(sprout, next) + 0.25 * options_.tortuosity * random_.normal();
      sprout.place += kStep_um * heading(sprout.angle + winding);
    }
    taperEnd(vessel);
    if (vessel.nodes.size() >= 4) vessels_.push_back(std::move(vessel));
  }

  bool outsideDisc(const Vector2d& place) const { return (place - plan_.disc).norm() > 1.05 * plan_.disc_radius; }
  double branchDistance(double radius) const { return options_.branch_distance_um * std::sqrt((radius + 10.0) / 30.0); }

  bool mayGrow(const Sprout& sprout, int id, bool young)
  {
    const Vector2d ahead = sprout.place + 1.2 * options_.spacing_um * heading(sprout.angle);
    if (!territory_.contains(sprout.place) || 2.0 * sprout.radius < options_.thinnest_um) return false;
    if ((sprout.place - plan_.fovea).norm() < options_.avascular_um) return false;
    if (young || !sprout.guide.empty() || !outsideDisc(sprout.place)) return true;
    const int here = territory_.owner(sprout.kind, sprout.place);
    const int there = territory_.contains(ahead) ? territory_.owner(sprout.kind, ahead) : -1;
    return (here < 0 || here == id) && (there < 0 || there == id);
  }

  // A trunk looks to its next way point; a branch to the fovea, or away from the disc.
  double steered(Sprout& sprout, std::size_t& next) const
  {
    while (next < sprout.guide.size() && (sprout.guide[next] - sprout.place).norm() < 500.0) ++next;
    if (next == sprout.guide.size()) sprout.guide.clear();
    if (!sprout.guide.empty()) {
      return turnTowards(sprout.angle, sprout.guide[next] - sprout.place, 0.07);
    }
    const Vector2d wanted =
        sprout.to_fovea ? Vector2d(plan_.fovea - sprout.place) : Vector2d(sprout.place - plan_.disc);
    return turnTowards(sprout.angle, wanted, sprout.to_fovea ? 0.022 : 0.008);
  }

  // Divides by Murray's law: a trunk sends out a small side branch, a branch forks less unevenly.
  bool branch(Sprout& sprout, int id)
  {
    const bool trunk = !sprout.guide.empty();
    const double ratio = trunk ? random_.uniform(0.35, 0.85) : random_.uniform(0.45, 0.95);
    const double large = sprout.radius / std::cbrt(1.0 + ratio * ratio * ratio);
    const double small = ratio * large;
    const double r0 = std::pow(sprout.radius, 4);
    const double a = std::pow(large, 4);
    const double b = std::pow(small, 4);
    const double square = 2.0 * sprout.radius * sprout.radius;
    const double large_turn = std::acos(std::clamp((r0 + a - b) / (square * large * large), -1.0, 1.0));
    const double small_turn = std::acos(std::clamp((r0 + b - a) / (square * small * small), -1.0, 1.0));
    const double side = random_.chance(0.5) ? 1.0 : -1.0;
    Sprout twig{sprout.kind, sprout.place, sprout.angle + side * small_turn * random_.uniform(0.8, 1.15), small, id,
                {},          false};
    const Vector2d to_fovea = plan_.fovea - sprout.place;
    twig.to_fovea = to_fovea.norm() < 3600.0 && to_fovea.normalized().dot(heading(twig.angle)) > 0.15;
    sprouts_.push_back(twig);
    sprout.radius = large;
    if (!trunk) sprout.angle -= side * large_turn * random_.uniform(0.7, 1.1);
    return 2.0 * large >= options_.thinnest_um;
  }

  // Vessels do not end bluntly: they dive out of sight.
  void taperEnd(Vessel& vessel) const
  {
    const std::size_t count = vessel.nodes.size();
    const std::size_t length = std::min<std::size_t>(count, 12);
    for (std::size_t i = 0; i < length; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(length);
      vessel.nodes[count - 1 - i].radius *= 0.45 + 0.55 * part;
    }
  }

  RetinaPlan plan_;
  VesselTreeOptions options_;
  Random random_;
  Territory territory_;
  std::deque<Sprout> sprouts_;
  std::vector<Vessel> vessels_;
};

}  // namespace

std::vector<Vessel> growVessels(const RetinaPlan& plan, const VesselTreeOptions& options, std::uint64_t seed)
{
  return Growth(plan, options, seed).run();
}

}  // namespace eyeslam::simulation
