// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/vessel_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "eyeslam/retina/units.h"

namespace eyeslam::tracking {

namespace {

constexpr int kLevelTile = 64;  // frame px; each has levels of its own, from half as much again
constexpr int kSampling = 3;    // frame px, along a line of the grid
constexpr int kBin = 4;         // of the histograms of levels, 1 / Frame::kContrastUnit
constexpr int kBins = 512;
constexpr double kMedianOfDifferences = 0.954;  // of two normal samples, in sigma: 0.6745 sqrt 2
constexpr std::size_t kSeeds = 4096;            // tried; twice as many are collected at most
constexpr int kOwnSteps = 8;                    // a trace may touch what it claimed so few steps ago
constexpr double kUsualSteps = 8.0;             // what is usual follows a vessel that tapers, over so many steps
constexpr int kNarrowestClaim = 2;
constexpr int kMostClaims = 65000;  // labels have 16 bits
constexpr float kHalfTurn = static_cast<float>(kPi);

int round(float value) { return static_cast<int>(std::lround(value)); }

int wrapDirection(int direction) { return direction & (TracingKernels::kDirections - 1); }

std::size_t binOf(int level) { return static_cast<std::size_t>(std::clamp(level / kBin + kBins / 2, 0, kBins - 1)); }

// The level below which half of all samples lie, to a bin.
int median(const std::vector<int>& histogram, int total)
{
  int below = 0;
  std::size_t bin = 0;
  while (bin + 1 < histogram.size() && 2 * (below + histogram[bin]) <= total) below += histogram[bin++];
  return (static_cast<int>(bin) - kBins / 2) * kBin + kBin / 2;
}

// Of each point from `first` on: the chord over its neighbours, finer than 22.5 degrees.
void setDirections(std::size_t first, VesselPoints& points)
{
  constexpr std::size_t kReach = 2;
  for (std::size_t i = first; i < points.size(); ++i) {
    const VesselPoint& before = points[i >= first + kReach ? i - kReach : first];
    const VesselPoint& after = points[std::min(i + kReach, points.size() - 1)];
    const float angle = std::atan2(after.y - before.y, after.x - before.x);
    points[i].direction = angle < 0.0F ? angle + kHalfTurn : angle;
  }
}

}  // namespace

VesselTracer::VesselTracer(const VesselTracerOptions& options)
    : options_(options), kernels_(options.kernels), levels_seen_(kBins), differences_(kBins)
{
  seeds_.reserve(2 * kSeeds);
}

void VesselTracer::detect(const Frame& frame, const OcclusionMask& mask, VesselPoints& points)
{
  points.clear();
  points.reserve(static_cast<std::size_t>(options_.most_points) + 1);
  labels_.create(frame.height(), frame.width());
  std::fill(labels_.begin(), labels_.end(), std::uint16_t{0});  // setTo would allocate
  claims_ = 0;

  const cv::Mat_<std::int16_t>& plane = frame.contrast();
  kernels_.assign(plane);
  estimateLevels(plane, mask);
  findSeeds(plane, mask);
  for (const Seed& seed : seeds_) {
    if (isFull(points)) return;
    Place place;
    if (labels_(seed.y, seed.x) == 0 && validate(seed, mask, place)) trace(place, mask, points);
  }
}

// Per tile, because a dark corner is noisier than the rest: its grey levels are multiplied by more.
void VesselTracer::estimateLevels(const cv::Mat_<std::int16_t>& plane, const OcclusionMask& mask)
{
  tile_columns_ = (plane.cols + kLevelTile - 1) / kLevelTile;
  levels_.clear();
  const cv::Rect view(0, 0, plane.cols, plane.rows);
  for (int y = 0; y < plane.rows; y += kLevelTile) {
    for (int x = 0; x < plane.cols; x += kLevelTile) {
      const cv::Rect tile(x - kLevelTile / 4, y - kLevelTile / 4, kLevelTile * 3 / 2, kLevelTile * 3 / 2);
      levels_.push_back(estimateLevels(plane, mask, tile & view));
    }
  }
}

// Median level and noise on some lines of the grid: no pass over all pixels (facts A2.3.1). The noise is that between
// neighbouring samples: it is small beside the contrast of vessels, even where they are many, yet grows with grain.
VesselTracer::Levels VesselTracer::estimateLevels(const cv::Mat_<std::int16_t>& plane, const OcclusionMask& mask,
                                                  const cv::Rect& tile)
{
  std::fill(levels_seen_.begin(), levels_seen_.end(), 0);
  std::fill(differences_.begin(), differences_.end(), 0);
  int total = 0;
  for (int y = tile.y + options_.grid_pitch_px / 2; y < tile.y + tile.height; y += options_.grid_pitch_px) {
    const std::int16_t* row = plane[y];
    for (int x = tile.x; x + kSampling < tile.x + tile.width; x += kSampling) {
      if (!mask.isVisible(x, y)) continue;
      ++levels_seen_[binOf(row[x])];
      ++differences_[binOf(std::abs(row[x + kSampling] - row[x]))];
      ++total;
    }
  }
  Levels levels;
  levels.median = median(levels_seen_, total);
  const double noise = median(differences_, total) / kMedianOfDifferences;
  levels.seed = levels.median - std::max(1, static_cast<int>(options_.seed_depth * noise));
  const double least = options_.lowest_strength * Frame::kContrastUnit;
  levels.start = static_cast<int>(std::max(options_.seed_strength * noise, least));
  levels.go_on = static_cast<int>(std::max(options_.edge_strength * noise, least));
  return levels;
}

const VesselTracer::Levels& VesselTracer::levelsAt(int x, int y) const
{
  return levels_[static_cast<std::size_t>(y / kLevelTile * tile_columns_ + x / kLevelTile)];
}

// Local minima along the grid's lines (facts A2.3.2), darkest first: strong vessels claim their pixels before weak
// ones.
void VesselTracer::findSeeds(const cv::Mat_<std::int16_t>& plane, const OcclusionMask& mask)
{
  seeds_.clear();
  const int first = options_.grid_pitch_px / 2;
  const auto row_step = static_cast<std::ptrdiff_t>(plane.step1());
  for (int y = first; y < plane.rows; y += options_.grid_pitch_px)
    for (int x = 1; x < plane.cols - 1; ++x) consider(plane[y] + x, 1, x, y, mask);
  for (int y = 1; y < plane.rows - 1; ++y)
    for (int x = first; x < plane.cols; x += options_.grid_pitch_px) consider(plane[y] + x, row_step, x, y, mask);
  keepStrongest();
  std::sort(seeds_.begin(), seeds_.end(), isStronger);
}

// Of the whole view, not the first ones: a large picture has more minima than can be tried.
void VesselTracer::keepStrongest()
{
  if (seeds_.size() <= kSeeds) return;
  std::nth_element(seeds_.begin(), seeds_.begin() + static_cast<std::ptrdiff_t>(kSeeds), seeds_.end(), isStronger);
  seeds_.resize(kSeeds);
}

bool VesselTracer::isStronger(const Seed& a, const Seed& b)
{
  return a.depth != b.depth ? a.depth > b.depth : (a.y != b.y ? a.y < b.y : a.x < b.x);
}

void VesselTracer::consider(const std::int16_t* at, std::ptrdiff_t step, int x, int y, const OcclusionMask& mask)
{
  if (at[0] > at[-step] || at[0] > at[step]) return;
  const Levels& levels = levelsAt(x, y);
  const int level = (at[-step] + 2 * at[0] + at[step]) / 4;
  if (level > levels.seed || !mask.isVisible(x, y)) return;
  if (seeds_.size() == 2 * kSeeds) keepStrongest();
  seeds_.push_back({levels.median - level, x, y});
}

// All orientations; the best left and the best right edge must be parallel to within one step (facts A2.3.5).
bool VesselTracer::validate(const Seed& seed, const OcclusionMask& mask, Place& place) const
{
  int best = 0, best_left = 0, best_right = 0;
  std::array<VesselEdges, TracingKernels::kOrientations> all;
  for (int o = 0; o < TracingKernels::kOrientations; ++o) {
    VesselEdges& edges = all[static_cast<std::size_t>(o)];
    edges = kernels_.evaluate(seed.x, seed.y, o, 1, options_.farthest_edge_px);
    if (edges.sum() > all[static_cast<std::size_t>(best)].sum()) best = o;
    if (edges.left > all[static_cast<std::size_t>(best_left)].left) best_left = o;
    if (edges.right > all[static_cast<std::size_t>(best_right)].right) best_right = o;
  }
  const int apart = std::abs(best_left - best_right);
  if (std::min(apart, TracingKernels::kOrientations - apart) > 1) return false;
  place = {static_cast<float>(seed.x), static_cast<float>(seed.y), best, all[static_cast<std::size_t>(best)]};
  centre(place);
  return mask.isVisible(round(place.x), round(place.y)) &&
         isStrong(place, levelsAt(round(place.x), round(place.y)).start);
}

// Both ways from the seed. A short trace is dropped, but its pixels stay claimed: the next seed would repeat it.
void VesselTracer::trace(const Place& seed, const OcclusionMask& mask, VesselPoints& points)
{
  trace_start_ = branch_start_ = claims_;
  if (!isFree(seed, mask)) return;
  claim(seed);
  const std::size_t first = points.size();
  Place backward = seed;
  backward.direction = wrapDirection(seed.direction + TracingKernels::kDirections / 2);
  follow(backward, mask, points);
  std::reverse(points.begin() + static_cast<std::ptrdiff_t>(first), points.end());
  if (!isFull(points)) points.push_back(pointAt(seed));
  branch_start_ = claims_;
  follow(seed, mask, points);
  if (points.size() - first < static_cast<std::size_t>(options_.shortest_trace)) points.resize(first);
  setDirections(first, points);
}

void VesselTracer::follow(Place place, const OcclusionMask& mask, VesselPoints& points)
{
  const std::size_t first = points.size();
  const auto step = static_cast<float>(options_.step_px);
  double usual = place.edges.sum();
  int weak = 0;
  while (!isFull(points)) {
    const Eigen::Vector2f& along = kernels_.direction(place.direction);
    const float x = place.x + step * along.x();
    const float y = place.y + step * along.y();
    if (!mask.isVisible(round(x), round(y))) break;
    place = bestPlace(place, round(x), round(y));
    if (!isFree(place, mask)) break;
    const int least =
        std::max(levelsAt(round(place.x), round(place.y)).go_on, static_cast<int>(options_.fading * usual));
    weak = isStrong(place, least) ? 0 : weak + 1;
    if (weak == 0) usual += (place.edges.sum() - usual) / kUsualSteps;
    if (weak > options_.weak_steps) {
      --weak;
      break;
    }
    claim(place);
    points.push_back(pointAt(place));
  }
  // The weak steps at the end led nowhere.
  points.resize(points.size() - std::min(static_cast<std::size_t>(weak), points.size() - first));
}

// The best of the directions around the last one at (x, y), moved to the middle of its edges (facts A2.3.6).
VesselTracer::Place VesselTracer::bestPlace(const Place& from, int x, int y) const
{
  // A vessel's width changes slowly; the nearest strong edge may belong to its neighbour.
  const int half = (from.edges.left_offset + from.edges.right_offset) / 2;
  const int farthest = std::min(options_.farthest_edge_px, half + 3);
  Place best;
  int best_sum = -1;
  for (int turn = 0; turn <= 2 * options_.turn; ++turn) {
    // Straight on first, so that ties go there.
    const int change = turn % 2 == 0 ? turn / 2 : -(turn + 1) / 2;
    const int direction = wrapDirection(from.direction + change);
    const VesselEdges edges = kernels_.evaluate(x, y, direction % TracingKernels::kOrientations, 1, farthest);
    if (edges.sum() <= best_sum) continue;
    best_sum = edges.sum();
    best = {static_cast<float>(x), static_cast<float>(y), direction, edges};
  }
  if (best_sum < 0) return {static_cast<float>(x), static_cast<float>(y), from.direction, {}};
  centre(best);
  return best;
}

void VesselTracer::centre(Place& place) const
{
  const Eigen::Vector2f axis = TracingKernels::normalAxis(place.direction % TracingKernels::kOrientations);
  const float shift = static_cast<float>(place.edges.right_offset - place.edges.left_offset) / 2.0F;
  place.x += shift * axis.x();
  place.y += shift * axis.y();
}

bool VesselTracer::isStrong(const Place& place, int least) const
{
  const auto [weaker, stronger] = std::minmax({place.edges.left, place.edges.right});
  return place.edges.sum() >= least && weaker >= options_.weaker_edge * stronger;
}

// In view, and not claimed: by another trace, or by this one before it came round in a loop.
bool VesselTracer::isFree(const Place& place, const OcclusionMask& mask) const
{
  const int x = round(place.x);
  const int y = round(place.y);
  if (!mask.isVisible(x, y)) return false;
  const int label = labels_(y, x);
  if (label == 0) return true;
  if (label <= trace_start_) return false;
  if (label > branch_start_) return claims_ - label < kOwnSteps;
  // The second branch starts beside the first steps of the first one.
  return label - trace_start_ <= kOwnSteps && claims_ - branch_start_ < kOwnSteps;
}

void VesselTracer::claim(const Place& place)
{
  const auto label = static_cast<std::uint16_t>(++claims_);
  const int reach = std::max(kNarrowestClaim, static_cast<int>(calibre(place) / 2.0F));
  const int px = round(place.x);
  const int py = round(place.y);
  for (int y = std::max(0, py - reach); y <= std::min(labels_.rows - 1, py + reach); ++y) {
    std::uint16_t* row = labels_[y];
    for (int x = std::max(0, px - reach); x <= std::min(labels_.cols - 1, px + reach); ++x)
      if (row[x] == 0) row[x] = label;
  }
}

float VesselTracer::calibre(const Place& place) const
{
  return static_cast<float>(place.edges.left_offset + place.edges.right_offset) *
         kernels_.widthPerStep(place.direction % TracingKernels::kOrientations);
}

VesselPoint VesselTracer::pointAt(const Place& place) const
{
  const float strength = static_cast<float>(place.edges.sum()) / (2.0F * Frame::kContrastUnit);
  return {place.x, place.y, strength, 0.0F, calibre(place)};
}

bool VesselTracer::isFull(const VesselPoints& points) const
{
  return static_cast<int>(points.size()) >= options_.most_points || claims_ >= kMostClaims;
}

}  // namespace eyeslam::tracking
