// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/scan_matcher.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "eyeslam/retina/units.h"
#include "eyeslam/tracking/block_search.h"
#include "eyeslam/tracking/max_pooled_tables.h"
#include "eyeslam/tracking/response_surface.h"
#include "eyeslam/tracking/turned_points.h"

namespace eyeslam::tracking {

namespace {

using retina::Pose2;
using retina::Reason;

constexpr int kMostMatched = 4000;
constexpr std::int64_t kMostCells = 1 << 24;
constexpr int kMostHalf = 500;         // cells or steps each way
constexpr int kRowsComputedAll = 200;  // rows of 16 poses; up to here computing all is faster than bounding
constexpr int kSurfaceCells = 10;      // around the best of a larger window: more than a block, so that no rival hides
constexpr int kSurfaceSteps = 3;
constexpr int kMostSurface = (2 * kSurfaceCells + 1) * 32 * (2 * kSurfaceSteps + 1);  // poses, rows in whole kernels
constexpr int kWindowPeak = 3;  // cells or steps: two poses closer than this are one place
constexpr int kMostJudgedRivals = 32;
constexpr double kMostMagnified = 10.0;  // a scale beyond is no view of the retina

int halfFor(double half, double step, int least, int most)
{
  // Written so that NaN gives the widest window.
  const double steps = std::ceil(half / step - 1e-9);
  return steps <= most ? std::max(static_cast<int>(std::max(steps, 0.0)), least) : most;
}

double sigma(double variance) { return variance >= 0.0 ? std::sqrt(variance) : HUGE_VAL; }

bool isUsable(const Pose2& pose, double cell_px)
{
  const double reach = OccupancyMap::kReach_cells * cell_px;
  return std::abs(pose.x) < reach && std::abs(pose.y) < reach && std::isfinite(pose.theta) &&
         pose.scale > 1.0 / kMostMagnified && pose.scale < kMostMagnified;
}

bool isFarFrom(const GridPose& a, const GridPose& b)
{
  return std::max({std::abs(a.k - b.k), std::abs(a.j - b.j), std::abs(a.i - b.i)}) > kWindowPeak;
}

}  // namespace

class ScanMatcher::Steps {
 public:
  explicit Steps(const ScanMatcherOptions& options) : options_(options), greedy_(options.search == "greedy") {}

  void reserve(const cv::Size& frame, double cell_px);
  bool begin(const ScanPoints& points, const OccupancyMap& map, const Pose2& centre, MatchResult& result);
  void widenTo(const PosePrediction& predicted);
  void widenTo(const SearchWindow& window);
  MatchResult run(const OccupancyMap& map);

 private:
  GridPose findComputingAll();
  GridPose findByBounds();
  GridPose findGreedily();
  void keepRivals(const GridPose& best);
  bool hasRival(const GridPose& best);
  bool separatedByValley(const GridPose& a, const GridPose& b) const;
  std::uint32_t sumAt(int k, int j, int i) const;
  MatchResult judge(const GridPose& best);

  ScanMatcherOptions options_;
  bool greedy_;
  PoseGrid grid_;
  TurnedPoints points_;
  MaxPooledTables tables_;
  cv::Point origin_;  // cell at which the tables begin
  BlockSearch blocks_;
  ResponseSurface surface_;
  std::vector<GridPose> rivals_;
};

void ScanMatcher::Steps::reserve(const cv::Size& frame, double cell_px)
{
  constexpr int kPoints = 1000;
  const int half = std::max(options_.most_cells, 64), steps = std::max(options_.most_steps, 16);
  const int diameter = static_cast<int>(1.2 * std::hypot(frame.width, frame.height) / cell_px) + 2;
  points_.reserve(kPoints, 2 * steps + 1);
  tables_.reserve({diameter + 2 * half, diameter + 2 * half});
  blocks_.reserve((2 * steps + 1) * (half / 4 + 2) * (half / 4 + 34), kPoints);
  surface_.reserve(kMostSurface, kPoints);
  rivals_.reserve(kMostSurface);
}

bool ScanMatcher::Steps::begin(const ScanPoints& points, const OccupancyMap& map, const Pose2& centre,
                               MatchResult& result)
{
  result.map_T_frame = centre;
  result.reason = Reason::poor_match;
  if (!isUsable(centre, map.cellSize())) return false;
  points_.assign(points, kMostMatched);
  result.reason = Reason::too_few_points;
  if (points_.size() < std::max(1, options_.min_points)) return false;
  grid_.centre = centre;
  grid_.cell_px = map.cellSize();
  grid_.theta_step = points_.stepFor(grid_.cell_px, centre.scale);
  return true;
}

void ScanMatcher::Steps::widenTo(const PosePrediction& predicted)
{
  const auto half = [&](int axis, double step, int least, int most) {
    const double reach = options_.window_sigmas * sigma(predicted.covariance(axis, axis));
    return halfFor(reach, step, least, std::max(least, most));
  };
  grid_.half_i = half(0, grid_.cell_px, options_.least_cells, options_.most_cells);
  grid_.half_j = half(1, grid_.cell_px, options_.least_cells, options_.most_cells);
  grid_.half_k = half(2, grid_.theta_step, options_.least_steps, options_.most_steps);
}

void ScanMatcher::Steps::widenTo(const SearchWindow& window)
{
  grid_.half_i = halfFor(window.half_x_px, grid_.cell_px, 0, kMostHalf);
  grid_.half_j = halfFor(window.half_y_px, grid_.cell_px, 0, kMostHalf);
  const int half_turn = static_cast<int>(kPi / grid_.theta_step);
  grid_.half_k = halfFor(window.half_theta, grid_.theta_step, 0, std::min(half_turn, kMostHalf));
}

MatchResult ScanMatcher::Steps::run(const OccupancyMap& map)
{
  points_.turn(grid_, -grid_.half_k, 2 * grid_.half_k + 1);
  const cv::Point half(grid_.half_i, grid_.half_j);
  const cv::Rect touched(points_.extent().tl() - half, points_.extent().br() + half);
  origin_ = touched.tl();
  rivals_.clear();
  const bool too_large = std::int64_t{touched.width} * touched.height > kMostCells;  // points far outside any frame
  if (too_large || (touched & map.knownCells()).empty())
    return {Reason::poor_match, grid_.centre, 0.0, Eigen::Matrix3d::Zero()};
  tables_.assign(map, touched);
  const int rows = grid_.rows() * ((grid_.columns() + 15) / 16) * points_.angles();
  if (greedy_) return judge(findGreedily());
  return judge(rows <= kRowsComputedAll ? findComputingAll() : findByBounds());
}

GridPose ScanMatcher::Steps::findComputingAll()
{
  surface_.evaluate(points_, tables_, origin_, PoseBox::whole(grid_));
  const GridPose best = surface_.best();
  keepRivals(best);
  return best;
}

GridPose ScanMatcher::Steps::findByBounds()
{
  tables_.pool();
  BlockSearch::Limits limits;
  limits.least_sum = static_cast<std::uint32_t>(std::ceil(options_.min_score * 255.0 * points_.size()));
  limits.rival_ratio = std::min(1.0, options_.ambiguous_ratio);
  blocks_.search(grid_, points_, tables_, origin_, limits);
  rivals_.assign(blocks_.rivals().begin(), blocks_.rivals().end());
  const GridPose best = blocks_.found() ? blocks_.best() : GridPose{0, 0, 0, sumAt(0, 0, 0)};
  surface_.evaluate(points_, tables_, origin_, PoseBox::around(best, grid_, kSurfaceSteps, kSurfaceCells));
  keepRivals(best);
  return best;
}

// The paper's search: one coarse scan, one fine scan around its winner. It can miss the maximum where vessels repeat.
GridPose ScanMatcher::Steps::findGreedily()
{
  constexpr int kCoarseCells = 4, kCoarseSteps = 2;
  GridPose best{0, 0, 0, sumAt(0, 0, 0)};
  const auto first = [](int half, int step) { return -(half / step) * step; };
  for (int k = first(grid_.half_k, kCoarseSteps); k <= grid_.half_k; k += kCoarseSteps) {
    for (int j = first(grid_.half_j, kCoarseCells); j <= grid_.half_j; j += kCoarseCells) {
      for (int i = first(grid_.half_i, kCoarseCells); i <= grid_.half_i; i += kCoarseCells) {
        const GridPose pose{k, j, i, sumAt(k, j, i)};
        if (isBetter(pose, best)) best = pose;
      }
    }
  }
  surface_.evaluate(points_, tables_, origin_, PoseBox::around(best, grid_, kCoarseSteps - 1, kCoarseCells - 1));
  return surface_.best();
}

void ScanMatcher::Steps::keepRivals(const GridPose& best)
{
  if (options_.ambiguous_ratio > 1.0) return;
  const double least = std::ceil(best.sum * options_.ambiguous_ratio);
  surface_.forEachFrom(static_cast<std::uint32_t>(least), [&](const GridPose& pose) {
    if (isFarFrom(pose, best)) rivals_.push_back(pose);
  });
}

bool ScanMatcher::Steps::hasRival(const GridPose& best)
{
  const auto is_same = [&](const GridPose& pose) { return !isFarFrom(pose, best); };
  rivals_.erase(std::remove_if(rivals_.begin(), rivals_.end(), is_same), rivals_.end());
  const auto judged =
      rivals_.begin() + std::min<std::ptrdiff_t>(kMostJudgedRivals, std::distance(rivals_.begin(), rivals_.end()));
  std::partial_sort(rivals_.begin(), judged, rivals_.end(), isBetter);
  return std::any_of(rivals_.begin(), judged, [&](const GridPose& rival) { return separatedByValley(rival, best); });
}

// Along one straight vessel the score stays high from one pose to the other: that is a direction not fixed, and the
// covariance says so. Between two places it falls.
bool ScanMatcher::Steps::separatedByValley(const GridPose& a, const GridPose& b) const
{
  const int steps = std::max({std::abs(a.k - b.k), std::abs(a.j - b.j), std::abs(a.i - b.i)});
  const auto between = [&](int from, int to, int step) {
    return static_cast<int>(std::lround(from + (to - from) * (static_cast<double>(step) / steps)));
  };
  for (int step = 1; step < steps; ++step) {
    const std::uint32_t sum = sumAt(between(a.k, b.k, step), between(a.j, b.j, step), between(a.i, b.i, step));
    if (sum < options_.valley_ratio * b.sum) return true;
  }
  return false;
}

std::uint32_t ScanMatcher::Steps::sumAt(int k, int j, int i) const
{
  const std::int32_t* x = points_.cellX(k);
  const std::int32_t* y = points_.cellY(k);
  const std::ptrdiff_t first = (j - origin_.y) * tables_.stride() + i - origin_.x;
  std::uint32_t sum = 0;
  for (int n = 0; n < points_.size(); ++n) sum += tables_.cells()[first + y[n] * tables_.stride() + x[n]];
  return sum;
}

MatchResult ScanMatcher::Steps::judge(const GridPose& best)
{
  MatchResult result;
  result.map_T_frame = grid_.pose(best.k, best.j, best.i);
  result.score = best.sum / (255.0 * points_.size());
  result.covariance = surface_.covariance(grid_, points_.size(), options_.temperature);
  if (result.score < options_.min_score) {
    result.reason = Reason::poor_match;
  } else if (hasRival(best)) {
    result.reason = Reason::ambiguous;
  }
  return result;
}

ScanMatcher::ScanMatcher(const ScanMatcherOptions& options) : steps_(std::make_unique<Steps>(options)) {}
ScanMatcher::~ScanMatcher() = default;
ScanMatcher::ScanMatcher(ScanMatcher&&) noexcept = default;
ScanMatcher& ScanMatcher::operator=(ScanMatcher&&) noexcept = default;

void ScanMatcher::reserve(const cv::Size& frame, double cell_px) { steps_->reserve(frame, cell_px); }

MatchResult ScanMatcher::match(const ScanPoints& points, const OccupancyMap& map,
                               const PosePrediction& predicted) noexcept
{
  MatchResult result;
  if (!steps_->begin(points, map, predicted.map_T_frame, result)) return result;
  steps_->widenTo(predicted);
  return steps_->run(map);
}

MatchResult ScanMatcher::search(const ScanPoints& points, const OccupancyMap& map, const SearchWindow& window) noexcept
{
  MatchResult result;
  if (!steps_->begin(points, map, window.centre, result)) return result;
  steps_->widenTo(window);
  return steps_->run(map);
}

}  // namespace eyeslam::tracking
