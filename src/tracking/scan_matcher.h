// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/match_result.h"
#include "eyeslam/tracking/occupancy_map.h"
#include "eyeslam/tracking/vessel_point.h"

namespace eyeslam::tracking {

struct ScanMatcherOptions {
  std::string search = "exact";
  int min_points = 30;
  double min_score = 0.3;
  double window_sigmas = 3.0;
  int least_cells = 4;
  int least_steps = 2;
  int most_cells = 24;
  int most_steps = 8;
  double temperature = 0.05;
  double ambiguous_ratio = 0.95;
  double valley_ratio = 0.8;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.choice("search", self.search, {"exact", "greedy"},
                   "exact: the maximum of the window; greedy: every fourth pose, then around the best, as the paper; "
                   "source: facts A3.2");
    visitor.field("min_points", self.min_points, Range{1, 5000}, "points",
                  "fewer cannot be matched; source: 30 points of one vessel fit by chance somewhere");
    visitor.field("min_score", self.min_score, Range{0.0, 1.0}, "mean cell value",
                  "lower is poor_match; source: tracker study 2.8 (0.2 to 0.45 alike)");
    visitor.field("window_sigmas", self.window_sigmas, Range{1.0, 10.0}, "sigma",
                  "half width of match()'s window; source: tracker study 2.8");
    visitor.field("least_cells", self.least_cells, Range{0, 500}, "cells",
                  "match()'s window reaches at least so far each way; source: tracker study 2.8");
    visitor.field("least_steps", self.least_steps, Range{0, 500}, "angular steps",
                  "match()'s window reaches at least so far each way; source: tracker study 2.8");
    visitor.field("most_cells", self.most_cells, Range{0, 500}, "cells",
                  "match()'s window reaches at most so far each way: the wide search is the lost view's; "
                  "source: tracker study 2.8");
    visitor.field("most_steps", self.most_steps, Range{0, 500}, "angular steps",
                  "match()'s window reaches at most so far each way; source: tracker study 2.8");
    visitor.field("temperature", self.temperature, Range{0.001, 1.0}, "of the score",
                  "a pose that scores this much less weighs 1/e in the covariance; source: facts A3.1");
    visitor.field("ambiguous_ratio", self.ambiguous_ratio, Range{0.5, 2.0}, "of the best score",
                  "a second place that scores this is one too many; above 1 never; source: periodic maps in the tests");
    visitor.field("valley_ratio", self.valley_ratio, Range{0.0, 1.0}, "of the best score",
                  "two places are different when the score falls below this between them; source: a straight vessel's "
                  "ridge stays above");
  }
};

/// Correlative scan matching: finds the pose at which the points agree best with the map, exactly over its window.
/// The poses tried are the window's centre plus whole cells and whole angular steps; a step moves the farthest point by
/// one cell. Ties go to the pose nearest the centre, or equal scores would make the result depend on the order of
/// search. Source: Olson 2009; Hess et al. 2016 (facts A3).
///
///   ScanMatcher matcher;
///   matcher.reserve({400, 304});
///   MatchResult found = matcher.match(points, map, filter.predict(1.0));
///
/// Never throws; allocates nothing after `reserve`, unless points lie outside that frame.
class ScanMatcher {
 public:
  explicit ScanMatcher(const ScanMatcherOptions& options = {});
  ~ScanMatcher();
  ScanMatcher(ScanMatcher&&) noexcept;
  ScanMatcher& operator=(ScanMatcher&&) noexcept;

  /// Takes the memory for frames of this size (frame px), the widest window and the given cells, once.
  void reserve(const cv::Size& frame, double cell_px = 2.0);

  /// Searches around a prediction.
  /// @param points     vessel points of one frame, centred frame px; not kept
  /// @param map        occupancy
  /// @param predicted  its covariance makes the window, its scale is applied to the points
  /// @return  pose, score, covariance; or the reason: too_few_points, ambiguous, poor_match. A direction that the
  /// points
  ///          do not fix (one straight vessel) gets a large variance and is no error.
  MatchResult match(const ScanPoints& points, const OccupancyMap& map, const PosePrediction& predicted) noexcept;
  /// Searches a window of the caller's choice, at most 500 cells and steps each way.
  MatchResult search(const ScanPoints& points, const OccupancyMap& map, const SearchWindow& window) noexcept;

 private:
  class Steps;
  std::unique_ptr<Steps> steps_;
};

}  // namespace eyeslam::tracking
