// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/match_result.h"
#include "eyeslam/tracking/occupancy_map.h"
#include "eyeslam/tracking/vessel_point.h"

namespace eyeslam::tracking {

struct RelocalizerOptions {
  double half_angle_deg = 15.0;
  int most_points = 200;
  int min_points = 30;
  double min_score = 0.35;
  double sure_score = 0.5;
  double ambiguous_ratio = 0.95;
  int budget = 5000;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("half_angle_deg", self.half_angle_deg, Range{0.0, 180.0}, "deg",
                  "angles searched each side of the last pose's, 180 = all; source: tracker study 2.8");
    visitor.field("most_points", self.most_points, Range{30, 250}, "points",
                  "taken of those given, evenly; source: tracker study 2.8");
    visitor.field("min_points", self.min_points, Range{1, 250}, "points", "fewer are too_few_points; source: as match");
    visitor.field("min_score", self.min_score, Range{0.0, 1.0}, "mean cell value",
                  "lower is poor_match; source: tracker study 2.8, raised because a whole map offers more chances");
    visitor.field("sure_score", self.sure_score, Range{0.0, 1.0}, "mean cell value",
                  "accepted although not everything was searched; source: a true view scores 0.6 to 0.9 in the tests");
    visitor.field("ambiguous_ratio", self.ambiguous_ratio, Range{0.5, 2.0}, "of the best score",
                  "a second place that scores this is one too many; above 1 never; source: periodic maps in the tests");
    visitor.field(
        "budget", self.budget, Range{100, 1000000}, "thousand vector operations a frame",
        "work of one call; source: measured, 5000 take 2 to 6 ms, 11 on a busy machine (relocalizer_benchmark)");
  }
};

/// Finds the view anywhere in the map while it is lost: the frame's centre anywhere in the known rectangle or a little
/// outside, angles around the last pose's.
///
/// Each call searches with the current frame's own points, because the eye moves on while the view is lost. What is
/// promised, with a budget of vector operations and not of time, so that the same input gives the same answer:
///   - A map for which the budget suffices is searched whole, every angle in every call, and the answer is that of
///   exhaustive search on the relocalizer's grid. With the defaults and views of 400 x 304 px this holds for 600 x 600
///   cells (1200 px, three views): every call answers. Of 1200 x 1200 cells 32 % of the calls do, of 3000 x 3000 19 %,
///   the others say `searching` (`found` of relocalizer_benchmark; the view moves on between calls).
///   - In a larger map each call searches the whole map for a sector of the angles, the nearest to the last pose first;
///     after as many calls as there are sectors every angle had its turn. Only a sure answer is then given, else
///     `searching`.
///   - A call whose budget ends while many places fit alike gives a sure answer or `searching`, and the next sectors
///     are half as wide until searches come to their end again.
///   - The tables over the map are made in slices; until they are current the answer is `searching`.
/// The grid has the map's cells for views up to 400 x 304 px; for larger views, two or more of them together, with
/// their maximum. The answer is then found again among the map's own cells by scan matching.
///
///   Relocalizer relocalizer;
///   relocalizer.reserve({400, 304});
///   MatchResult found = relocalizer.search(points, map, last_pose);
///
/// Never throws; allocates only when the map's rectangle has grown since the last call.
class Relocalizer {
 public:
  explicit Relocalizer(const RelocalizerOptions& options = {});
  ~Relocalizer();
  Relocalizer(Relocalizer&&) noexcept;
  Relocalizer& operator=(Relocalizer&&) noexcept;

  /// Says which views (frame px) will come, so that `prepare` can make the tables for them.
  void reserve(const cv::Size& frame);
  /// Works a slice on the tables without searching (in a blackout, say), so that the first search need not.
  /// @return whether the tables are current
  bool prepare(const OccupancyMap& map) noexcept;
  /// Searches one frame.
  /// @param points     vessel points of this frame, centred frame px
  /// @param last_pose  last good pose: angles around its theta are searched, its scale is kept
  /// @return  the pose; or too_few_points, ambiguous, poor_match; or searching, when the budget ended before an answer
  ///          (the best place so far is in the result, not to be trusted unverified)
  MatchResult search(const ScanPoints& points, const OccupancyMap& map, const retina::Pose2& last_pose) noexcept;
  /// What the last search compared at the end: its best place and up to three others that scored nearly as much, each
  /// found again among the map's own cells. Of use when it was ambiguous: other evidence may decide.
  const std::vector<MatchResult>& places() const noexcept;
  /// Starts the next search from the nearest angles again; call it when the view was found.
  void restart() noexcept;

 private:
  class Steps;
  std::unique_ptr<Steps> steps_;
};

}  // namespace eyeslam::tracking
