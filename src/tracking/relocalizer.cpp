// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/relocalizer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "eyeslam/retina/units.h"
#include "eyeslam/tracking/block_search.h"
#include "eyeslam/tracking/scan_matcher.h"
#include "eyeslam/tracking/turned_points.h"
#include "eyeslam/tracking/whole_map_tables.h"

namespace eyeslam::tracking {

namespace {

using retina::Pose2;
using retina::Reason;

constexpr double kMostRadius_cells = 64.0;  // of the view: larger cells, and so fewer angles, for larger views
constexpr double kShareOutside = 0.25;      // of the view's radius, by which its centre may leave the known rectangle
constexpr int kWholeMapPeak = 8;            // cells or steps: two poses closer than this are one place
constexpr std::size_t kMostPlaces = 4;      // found again among the map's own cells
constexpr double kCoarseLoss = 0.95;        // a rival may score so much less on larger cells than it deserves
constexpr double kSlack = 1.1;              // by which a scale over 1 may enlarge the view
constexpr double kBoundShare = 0.3;         // of the budget, for bounding; the rest opens blocks
constexpr double kCachedCells = 750e3;      // tables so large are read at full speed, larger ones slower in proportion
constexpr int kMostNarrowing = 64;

bool isUsable(const Pose2& pose)
{
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta) && pose.scale > 0.1 &&
         pose.scale < 10.0;
}

ScanMatcherOptions matcherOptions(const RelocalizerOptions& options)
{
  ScanMatcherOptions result;
  result.min_points = options.min_points;
  result.min_score = options.min_score;
  result.ambiguous_ratio = options.ambiguous_ratio;
  return result;
}

bool isOnePlace(const GridPose& a, const GridPose& b)
{
  return std::max({std::abs(a.k - b.k), std::abs(a.j - b.j), std::abs(a.i - b.i)}) <= kWholeMapPeak;
}

/// Number of the nth sector from the middle outwards: middle, right, left, ...
int fromTheMiddle(int n, int sectors)
{
  const int middle = (sectors - 1) / 2;
  return n % 2 == 1 ? middle + (n + 1) / 2 : middle - n / 2;
}

}  // namespace

class Relocalizer::Steps {
 public:
  explicit Steps(const RelocalizerOptions& options) : options_(options), matcher_(matcherOptions(options)) {}

  void reserve(const cv::Size& frame)
  {
    places_.reserve(kMostPlaces);
    found_again_.reserve(kMostPlaces);
    growTo(std::hypot(frame.width, frame.height) / 2.0);
    matcher_.reserve(frame);
  }
  bool prepare(const OccupancyMap& map);
  MatchResult search(const ScanPoints& points, const OccupancyMap& map, const Pose2& last_pose);
  const std::vector<MatchResult>& places() const { return found_again_; }
  void restart()
  {
    turn_ = 0;
    narrowing_ = 1;
  }

 private:
  void growTo(double radius_px);
  int radiusInCells() const;
  int margin() const;
  void chooseCells(const OccupancyMap& map);
  double budget() const;
  void layGrid(const OccupancyMap& map, const Pose2& last_pose);
  int chooseSector();
  void searchSector(int sectors);
  void listPlaces();
  MatchResult findAgain(const ScanPoints& points, const OccupancyMap& map, int sectors);

  RelocalizerOptions options_;
  ScanMatcher matcher_;
  double radius_px_ = 0.0;  // of the largest view, frame px
  int reduction_ = 1;       // cells of the map along one of the tables
  double cell_px_ = 0.0;    // of the tables
  WholeMapTables whole_;
  TurnedPoints points_;
  PoseGrid grid_;
  BlockSearch blocks_;
  std::vector<GridPose> places_;
  std::vector<MatchResult> found_again_;
  int turn_ = 0;
  int narrowing_ = 1;
};

// In coarse steps: every growth makes all tables anew.
void Relocalizer::Steps::growTo(double radius_px)
{
  constexpr double kStep_px = 16.0;
  if (radius_px > radius_px_) radius_px_ = std::ceil(radius_px / kStep_px) * kStep_px;
}

int Relocalizer::Steps::radiusInCells() const
{
  return static_cast<int>(std::ceil(kSlack * radius_px_ / cell_px_)) + 1;
}

int Relocalizer::Steps::margin() const { return static_cast<int>((1.0 + kShareOutside) * radiusInCells()) + 2; }

// As fine as the views allow, and the memory: a few points far out must not ask for gigabytes.
void Relocalizer::Steps::chooseCells(const OccupancyMap& map)
{
  reduction_ = std::max(1, static_cast<int>(std::ceil(radius_px_ / (map.cellSize() * kMostRadius_cells))));
  for (;; ++reduction_) {
    cell_px_ = map.cellSize() * reduction_;
    const cv::Rect area = WholeMapTables::areaOf(map.knownCells(), reduction_, margin());
    if (std::int64_t{area.width} * area.height <= WholeMapTables::kMostCells) return;
  }
}

bool Relocalizer::Steps::prepare(const OccupancyMap& map)
{
  if (map.empty() || radius_px_ == 0.0) return map.empty();
  chooseCells(map);
  return whole_.update(map, reduction_, margin(), std::int64_t{options_.budget} * 500);
}

// Vector operations that a call may take on tables of this size.
double Relocalizer::Steps::budget() const
{
  return 1000.0 * options_.budget / std::max(1.0, whole_.tables().size().area() / kCachedCells);
}

void Relocalizer::Steps::layGrid(const OccupancyMap& map, const Pose2& last_pose)
{
  const cv::Rect& known = map.knownCells();
  const int outside = static_cast<int>(kShareOutside * radiusInCells());
  const cv::Point middle(floorDivide(known.x + known.width / 2, reduction_),
                         floorDivide(known.y + known.height / 2, reduction_));
  grid_.centre = {middle.x * cell_px_, middle.y * cell_px_, last_pose.theta, last_pose.scale};
  grid_.cell_px = cell_px_;
  grid_.theta_step = points_.stepFor(cell_px_, last_pose.scale);
  grid_.half_i = known.width / (2 * reduction_) + outside;
  grid_.half_j = known.height / (2 * reduction_) + outside;
  const double half_angle = std::min(options_.half_angle_deg * kDegree, kPi);
  grid_.half_k = static_cast<int>(std::ceil(half_angle / grid_.theta_step));
}

// Turns the points to the sector whose turn it is.
int Relocalizer::Steps::chooseSector()
{
  const int angles = 2 * grid_.half_k + 1;
  const double per_angle = static_cast<double>(BlockSearch::operationsPerAngle(grid_, points_.size()));
  const int wide = static_cast<int>(std::clamp(kBoundShare * budget() / per_angle, 1.0, static_cast<double>(angles)));
  const int sectors = std::min(angles, (angles + wide - 1) / wide * narrowing_);
  const int width = (angles + sectors - 1) / sectors;
  const int first = std::min(fromTheMiddle(turn_ % sectors, sectors) * width, angles - width);
  points_.turn(grid_, first - grid_.half_k, width);
  ++turn_;
  return sectors;
}

void Relocalizer::Steps::searchSector(int sectors)
{
  const double loss = reduction_ > 1 ? kCoarseLoss : 1.0;
  // Of a part only a sure answer will be given.
  const double least = sectors == 1 ? options_.min_score : options_.sure_score;
  BlockSearch::Limits limits;
  limits.least_sum = static_cast<std::uint32_t>(std::ceil(least * loss * 255.0 * points_.size()));
  limits.rival_ratio = std::min(1.0, options_.ambiguous_ratio) * loss;
  const std::int64_t bounding = BlockSearch::operationsPerAngle(grid_, points_.size()) * points_.angles();
  limits.operations = std::max<std::int64_t>(0, static_cast<std::int64_t>(budget()) - bounding);
  blocks_.search(grid_, points_, whole_.tables(), whole_.origin(), limits);
  narrowing_ = blocks_.complete() ? 1 : std::min(kMostNarrowing, 2 * narrowing_);
}

// The best place and its best rivals elsewhere.
void Relocalizer::Steps::listPlaces()
{
  places_.assign(1, blocks_.best());
  while (places_.size() < kMostPlaces) {
    const GridPose* next = nullptr;
    for (const GridPose& rival : blocks_.rivals()) {
      const auto is_here = [&](const GridPose& place) { return isOnePlace(place, rival); };
      if (std::any_of(places_.begin(), places_.end(), is_here)) continue;
      if (!next || isBetter(rival, *next)) next = &rival;
    }
    if (!next) return;
    places_.push_back(*next);
  }
}

MatchResult Relocalizer::Steps::search(const ScanPoints& points, const OccupancyMap& map, const Pose2& last_pose)
{
  MatchResult nothing{Reason::too_few_points, last_pose, 0.0, Eigen::Matrix3d::Zero()};
  found_again_.clear();
  points_.assign(points, options_.most_points);
  if (points_.size() < options_.min_points) return nothing;
  nothing.reason = Reason::poor_match;
  if (map.empty() || !isUsable(last_pose)) return nothing;
  nothing.reason = Reason::searching;
  growTo(points_.radius() * last_pose.scale / kSlack);
  if (!prepare(map)) return nothing;
  layGrid(map, last_pose);
  const int sectors = chooseSector();
  searchSector(sectors);
  if (!blocks_.found()) {
    if (sectors == 1 && blocks_.complete()) nothing.reason = Reason::poor_match;
    return nothing;
  }
  listPlaces();
  return findAgain(points, map, sectors);
}

MatchResult Relocalizer::Steps::findAgain(const ScanPoints& points, const OccupancyMap& map, int sectors)
{
  MatchResult best;
  double second_score = 0.0;
  best.score = -1.0;
  for (const GridPose& place : places_) {
    const double half_px = 1.5 * cell_px_ + map.cellSize();
    const Pose2 about = grid_.pose(place.k, place.j, place.i);
    const MatchResult found = matcher_.search(points, map, {about, half_px, half_px, 1.5 * grid_.theta_step});
    found_again_.push_back(found);
    second_score = std::max(second_score, std::min(found.score, best.score));
    if (found.score > best.score) best = found;
  }
  const bool all_searched = sectors == 1 && blocks_.complete();
  const bool fits = best.reason == Reason::none;
  if (!all_searched && (!fits || best.score < options_.sure_score)) {
    best.reason = Reason::searching;
  } else if (fits && second_score >= options_.ambiguous_ratio * best.score) {
    best.reason = Reason::ambiguous;
  }
  return best;
}

Relocalizer::Relocalizer(const RelocalizerOptions& options) : steps_(std::make_unique<Steps>(options)) {}
Relocalizer::~Relocalizer() = default;
Relocalizer::Relocalizer(Relocalizer&&) noexcept = default;
Relocalizer& Relocalizer::operator=(Relocalizer&&) noexcept = default;

void Relocalizer::reserve(const cv::Size& frame) { steps_->reserve(frame); }
bool Relocalizer::prepare(const OccupancyMap& map) noexcept { return steps_->prepare(map); }
void Relocalizer::restart() noexcept { steps_->restart(); }
const std::vector<MatchResult>& Relocalizer::places() const noexcept { return steps_->places(); }

MatchResult Relocalizer::search(const ScanPoints& points, const OccupancyMap& map, const Pose2& last_pose) noexcept
{
  return steps_->search(points, map, last_pose);
}

}  // namespace eyeslam::tracking
