// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/localizer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace eyeslam::tracking {

namespace {

constexpr double kOnePlace_px = 8.0;  // frame px; candidates that refine to within this are one place

}  // namespace

struct Localizer::View {
  const MaskedContrast& frame;
  const ScanPoints& points;
  const OccupancyMap& occupancy;
  const Mosaic& mosaic;
  const PosePrediction& predicted;
  const retina::Pose2& last_pose;
  Freedom freedom;
};

Localizer::Localizer(const TrackerOptions& options)
    : options_(options.localizer),
      uncertainty_(options.uncertainty),
      cell_px_(options.occupancy.cell_px),
      matcher_(options.matcher),
      relocalizer_(options.relocalizer),
      dense_search_(options.dense),
      refiner_(options.refiner),
      smear_model_(options.smear, options.refiner)
{
  template_.reserve(1 << 14);
}

void Localizer::reserve(const cv::Size& frame)
{
  matcher_.reserve(frame, cell_px_);
  relocalizer_.reserve(frame);
  few_.reserve(static_cast<std::size_t>(options_.wide_points));
}

void Localizer::prepare(const OccupancyMap& occupancy) { relocalizer_.prepare(occupancy); }

void Localizer::restart()
{
  relocalizer_.restart();
  lost_frames_ = 0;
  refuted_ = false;
  running_ncc_ = 0.0;
}

Localization Localizer::localize(const MaskedContrast& frame, const ScanPoints& points, const OccupancyMap& occupancy,
                                 const Mosaic& mosaic, const PosePrediction& predicted, const retina::Pose2& last_pose,
                                 Freedom freedom)
{
  const View view{frame, points, occupancy, mosaic, predicted, last_pose, freedom};
  best_ = {};
  best_.reason = retina::Reason::poor_match;
  // Every search must fit into a frame: the windows around the prediction are searched once, when the view is lost; a
  // smeared frame has too few points for the whole map, a sharp one needs no dense search. Where few points are all
  // there ever is, the two take turns; as where the mosaic refutes the places that the points chose.
  const bool sharp = static_cast<int>(points.size()) >= options_.sharp_points;
  const bool just_now = lost_frames_ == 0;
  const bool anywhere = !refuted_ && (sharp || lost_frames_ % 2 == 1);
  const bool confirmed =
      matchNear(view) || (just_now && matchWide(view)) || (anywhere ? matchAnywhere(view) : matchDense(view));
  if (confirmed || best_.reason == retina::Reason::none) {
    lost_frames_ = 0;
    refuted_ = false;
    relocalizer_.restart();
    running_ncc_ = running_ncc_ > 0.0 ? 0.9 * running_ncc_ + 0.1 * best_.ncc : best_.ncc;
  } else {
    ++lost_frames_;
  }
  return best_;
}

// Around the prediction.
bool Localizer::matchNear(const View& view)
{
  const MatchResult match = matcher_.match(view.points, view.occupancy, view.predicted);
  if (match.reason != retina::Reason::none) {
    best_.reason = match.reason;
    return false;
  }
  return confirm(view, match.map_T_frame, match.score);
}

bool Localizer::matchWide(const View& view)
{
  const auto most = std::min(view.points.size(), static_cast<std::size_t>(options_.wide_points));
  few_.assign(view.points.begin(), view.points.begin() + static_cast<std::ptrdiff_t>(most));
  const double reach = options_.wide_cells * cell_px_;
  const double step = cell_px_ / std::hypot(view.frame.centre().x(), view.frame.centre().y());
  const MatchResult match =
      matcher_.search(few_, view.occupancy, {view.predicted.map_T_frame, reach, reach, options_.wide_steps * step});
  if (match.reason != retina::Reason::none) return false;
  return confirm(view, match.map_T_frame, match.score);
}

// Too smeared for points, or half outside the map where they score less than chance does in its middle: the dark and
// bright areas still correlate. A sharp frame is only taken when it fits as frames usually do.
bool Localizer::matchDense(const View& view)
{
  const bool strict = std::exchange(refuted_, false);
  const auto found = dense_search_.find(view.mosaic, view.frame, view.predicted.map_T_frame);
  if (!found) return false;
  const Refinement refined = align(view, *found);
  return (!strict || isConfirmed(refined)) && keep(view, refined, 0.0);
}

bool Localizer::matchAnywhere(const View& view)
{
  const MatchResult match = relocalizer_.search(view.points, view.occupancy, view.predicted.map_T_frame);
  // While the search goes on, its best place so far is only a guess, but the mosaic can tell.
  const bool guess = match.reason == retina::Reason::searching && match.score > 0.0;
  const bool found = (match.reason == retina::Reason::none || guess) && confirm(view, match.map_T_frame, match.score);
  if (found) return true;
  if (lost_frames_ >= options_.undecided_frames) {
    refuted_ = match.reason == retina::Reason::none || match.reason == retina::Reason::poor_match;
    if (match.reason == retina::Reason::ambiguous && decide(view)) return true;
  }
  // The last search knows best why there is no place, unless an earlier one left a place that will do.
  const bool refused = match.reason != retina::Reason::none && best_.reason != retina::Reason::none;
  if (refused) best_.reason = match.reason;
  return false;
}

// The vessels fit at several places alike, and the next frames may not tell either. The mosaic shows more than vessels;
// only a place that it prefers clearly is taken.
bool Localizer::decide(const View& view)
{
  Refinement best;
  double best_score = 0.0, rival_ncc = 0.0;
  for (const MatchResult& place : relocalizer_.places()) {
    const Refinement refined = align(view, place.map_T_frame);
    if (!refined.valid) continue;
    const Eigen::Vector2d apart = refined.map_T_frame.translation() - best.map_T_frame.translation();
    const bool same = best.valid && apart.norm() < kOnePlace_px;
    if (!same) rival_ncc = std::max(rival_ncc, std::min(refined.ncc, best.ncc));
    if (refined.ncc <= best.ncc) continue;
    best = refined;
    best_score = place.score;
  }
  refuted_ = !isConfirmed(best);
  return !refuted_ && rival_ncc < options_.rival_ncc * best.ncc && keep(view, best, best_score);
}

// Refines a candidate, smeared where the view moved fast.
Refinement Localizer::align(const View& view, const retina::Pose2& start)
{
  collectTemplate(view.mosaic, view.frame, start, template_);
  Refinement refined = refiner_.refine(view.frame.contrast, template_, start, view.freedom, options_.scale_sigma);
  const Eigen::Vector2d motion = refined.map_T_frame.translation() - view.last_pose.translation();
  const SmearModelOptions& smear = smear_model_.options();
  const bool plausible = refined.ncc > smear.least_ncc && refined.ncc < smear.ncc_share * running_ncc_;
  if (plausible && motion.norm() > smear.least_motion_px) {
    const Refinement smeared =
        smear_model_.refine(view.mosaic, view.frame, template_, refined.valid ? refined.map_T_frame : start, motion,
                            view.freedom, options_.scale_sigma);
    if (smeared.valid && smeared.ncc > refined.ncc) refined = smeared;
  }
  return refined;
}

bool Localizer::isConfirmed(const Refinement& refined) const
{
  return refined.valid && refined.settled && refined.ncc >= options_.least_ncc &&
         refined.ncc >= options_.ncc_share * running_ncc_;
}

// Compares a refined candidate with the mosaic and keeps it when it is the best so far. A wrong place may pass the
// plain threshold, so a candidate that correlates much worse than frames usually do is kept, but the search goes on.
bool Localizer::keep(const View& view, const Refinement& refined, double score)
{
  if (!refined.valid || refined.ncc < options_.least_ncc) return false;
  const bool confirmed = isConfirmed(refined);
  if (confirmed || refined.ncc > best_.ncc) {
    best_ = {retina::Reason::none,
             {refined.map_T_frame, honestCovariance(refined.covariance.topLeftCorner<3, 3>(), refined.ncc,
                                                    refined.map_T_frame, view.frame.size(), uncertainty_)},
             score,
             refined.ncc,
             refined.sigma};
  }
  return confirmed;
}

}  // namespace eyeslam::tracking
