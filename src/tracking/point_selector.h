// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/vessel_point.h"

namespace eyeslam::tracking {

struct PointSelectorOptions {
  int most_points = 500;
  double square_px = 32.0;
  int seed = 1;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("most_points", self.most_points, Range{8, 5000}, "points",
                  "kept for matching and mapping; source: tracker study 2.5");
    visitor.field("square_px", self.square_px, Range{4.0, 512.0}, "frame px",
                  "points are spread evenly over squares of this side; source: a view holds some 100 of them");
    visitor.field("seed", self.seed, Range{0, 2147483647}, "", "of the choice among equals; source: none needed");
  }
};

/// Chooses at most N points of a frame at random, but spread over the view: a square gives a second point only when
/// every square that has one gave its first, and so on. Same seed, same calls: same choice.
class PointSelector {
 public:
  explicit PointSelector(const PointSelectorOptions& options = {});

  /// @param points  vessel points, frame px
  /// @param centre  image centre, frame px
  /// @param chosen  filled (cleared first; capacity is kept) with centred frame px, in random order within each round
  void choose(const VesselPoints& points, const Eigen::Vector2d& centre, ScanPoints& chosen);
  /// The same, with another limit than the option's.
  void choose(const VesselPoints& points, const Eigen::Vector2d& centre, int most_points, ScanPoints& chosen);

  /// Starts the random sequence again.
  void restart();

 private:
  void shuffle(const VesselPoints& points);
  void sortByRound(const VesselPoints& points);

  PointSelectorOptions options_;
  std::mt19937 random_;
  std::vector<std::uint32_t> squares_;   // points met in each square
  std::vector<std::uint32_t> order_;     // numbers of the usable points, shuffled
  std::vector<std::uint32_t> round_;     // of each of them
  std::vector<std::uint32_t> starts_;    // where each round begins
  std::vector<std::uint32_t> by_round_;  // the numbers again, first round first
};

}  // namespace eyeslam::tracking
