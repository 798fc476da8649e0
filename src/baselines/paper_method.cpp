// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/baselines/paper_method.h"

#include <cmath>

#include "eyeslam/tracking/full_pixels.h"

namespace eyeslam::baselines {

using retina::Reason;
using tracking::MatchResult;
using tracking::PoseEstimate;
using tracking::PosePrediction;

namespace {

constexpr double kCell_px = 1.0;  // the tracker's own 2 px are for speed; refinement makes up for them there

// Frame 0 defines the map: its vessels count as if they had been seen so often, or the second frame would find nothing.
constexpr int kFirstHits = 4;
// Cells so fine are hit less evenly than the tracker's; a true match scores 0.4 to 0.7, a wrong one 0.1.
constexpr double kLeastScore = 0.2;

// What a point adds around it is as wide as in the tracker's grid of 2 px: the tracer's points scatter by half a pixel.
tracking::OccupancyMapOptions gridOptions()
{
  tracking::OccupancyMapOptions options;
  options.cell_px = kCell_px;
  return options;
}

// The same window in px as with the tracker's cells.
tracking::ScanMatcherOptions matcherOptions(const tracking::TrackerOptions& tracker)
{
  tracking::ScanMatcherOptions options = tracker.matcher;
  const double finer = tracker.occupancy.cell_px / kCell_px;
  for (int* count : {&options.least_cells, &options.least_steps, &options.most_cells, &options.most_steps})
    *count = static_cast<int>(std::lround(finer * *count));
  options.min_score = kLeastScore;
  return options;
}

}  // namespace

PaperMethod::PaperMethod(const tracking::TrackerOptions& options)
    : options_(options),
      masked_(options),
      structure_(options.structure),
      selector_(options.selector),
      matcher_(matcherOptions(options)),
      filter_(options.filter),
      grid_(gridOptions()),
      views_(kCell_px)
{}

const tracking::TrackResult& PaperMethod::track(const cv::Mat& image)
{
  ++result_.frame;
  const PosePrediction predicted = filter_.predict(1.0);
  if (const Reason why = observe(image); why != Reason::none) return refuse(why);
  if (grid_.empty()) {
    if (structure_.isNoise(masked_.frame(), masked_.mask())) return refuse(Reason::noise);
    const PoseEstimate origin{{}, 1e-6 * Eigen::Matrix3d::Identity()};
    filter_.reset(origin);
    for (int i = 0; i < kFirstHits; ++i) grid_.add(all_points_, {});
    return accept(origin, 0.0);
  }
  const MatchResult match = localize(predicted);
  if (match.reason != Reason::none) return refuse(match.reason);
  const PoseEstimate smoothed = filter_.correct({match.map_T_frame, match.covariance});
  grid_.decay(masked_.mask(), masked_.size(), smoothed.map_T_frame, result_.frame);
  grid_.add(all_points_, smoothed.map_T_frame);
  return accept(smoothed, match.score);
}

// Z_t: traced, culled, smoothed, at most 500 of them.
Reason PaperMethod::observe(const cv::Mat& image)
{
  traced_.clear();  // a refused frame shows no findings of the one before
  points_.clear();
  if (const Reason why = masked_.assign(image); why != Reason::none) return why;
  const tracking::Frame& frame = masked_.frame();
  tracer_.detect(frame, masked_.mask(), traced_);
  spurious_filter_.removeFrom(traced_, frame, masked_.mask());
  smoother_.smoothAcross(traced_, frame, masked_.mask());
  selector_.choose(traced_, frame.centre(), points_);
  selector_.choose(traced_, frame.centre(), static_cast<int>(traced_.size()), all_points_);
  const bool enough = static_cast<int>(points_.size()) >= options_.matcher.min_points;
  return enough ? Reason::none : Reason::too_few_points;
}

// B_t around the prediction; where that fails, in as wide a window as the tracker's second one.
MatchResult PaperMethod::localize(const PosePrediction& predicted)
{
  MatchResult near = matcher_.match(points_, grid_, predicted);
  if (near.reason == Reason::none) return near;
  tracking::SearchWindow wide;
  wide.centre = predicted.map_T_frame;
  wide.half_x_px = wide.half_y_px = options_.localizer.wide_cells * options_.occupancy.cell_px;
  const double farthest_px = masked_.frame().centre().norm();
  wide.half_theta = options_.localizer.wide_steps * options_.occupancy.cell_px / farthest_px;
  return matcher_.search(points_, grid_, wide);
}

const tracking::TrackResult& PaperMethod::accept(const PoseEstimate& map_T_frame, double score)
{
  map_T_frame_ = map_T_frame.map_T_frame;
  const Eigen::Vector3d unit(masked_.frame().pixelSize().x(), masked_.frame().pixelSize().y(), 1.0);
  result_.tracked = true;
  result_.reason = Reason::none;
  result_.map_T_frame = tracking::inFullPixels(map_T_frame_, masked_.frame());
  result_.velocity = unit.cwiseProduct(filter_.velocity());
  result_.covariance = unit.asDiagonal() * map_T_frame.covariance * unit.asDiagonal();
  result_.points = static_cast<int>(points_.size());
  result_.score = score;
  return result_;
}

const tracking::TrackResult& PaperMethod::refuse(Reason why)
{
  filter_.coast();
  return refuseFrame(result_, why, static_cast<int>(points_.size()));
}

void PaperMethod::updateMap()
{
  if (result_.tracked) views_.add(masked_.mask(), masked_.size(), map_T_frame_);
}

const retina::VesselMap& PaperMethod::vesselMap()
{
  const cv::Rect cells = grid_.knownCells();
  cv::Mat_<std::uint8_t> window;
  grid_.copyWindow(cells, window);
  const Eigen::Vector2d first =
      masked_.frame().pixelSize().cwiseProduct(kCell_px * Eigen::Vector2d(cells.x + 0.5, cells.y + 0.5));
  map_.width = cells.width;
  map_.height = cells.height;
  map_.px_per_cell = kCell_px * masked_.frame().pixelSize().x();
  map_.origin_x = masked_.frame().centreInImage().x() + first.x();
  map_.origin_y = masked_.frame().centreInImage().y() + first.y();
  map_.probability.assign(window.begin(), window.end());
  map_.calibre_px.assign(map_.probability.size(), 0);
  map_.seen.assign(map_.probability.size(), 0);
  // The grid knows no calibre: a cell's side is the least that a vessel there can have.
  const auto side = static_cast<std::uint8_t>(std::ceil(map_.px_per_cell));
  for (int y = 0; y < cells.height; ++y) {
    for (int x = 0; x < cells.width; ++x) {
      const std::size_t at = map_.index(x, y);
      if (map_.probability[at] >= 128) map_.calibre_px[at] = side;
      map_.seen[at] = views_.at(cells.x + x, cells.y + y);
    }
  }
  ++map_.version;
  return map_;
}

}  // namespace eyeslam::baselines
