// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/localizer.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::tracking {

struct Localizer::View {
  const Frame& frame;
  const OcclusionMask& mask;
  const Mosaic& mosaic;
};

Localizer::Localizer(const TrackerOptions& options)
    : options_(options.localizer),
      cell_px_(options.occupancy.cell_px),
      matcher_(options.matcher),
      relocalizer_(options.relocalizer),
      refiner_(options.refiner)
{
  template_.reserve(1 << 14);
}

void Localizer::restart()
{
  relocalizer_.restart();
  running_ncc_ = 0.0;
}

// Refines a candidate and compares it with the mosaic; remembers it when it is the best so far.
bool Localizer::confirm(const View& view, const MatchResult& match, bool wide)
{
  collectTemplate(view.mosaic, view.frame, view.mask, match.map_T_frame, template_);
  const Refinement refined = refiner_.refine(view.frame.contrast(), template_, match.map_T_frame, Freedom::rigid);
  if (!refined.converged || refined.ncc < options_.least_ncc) return false;
  if (refined.ncc > best_.ncc) {
    best_ = {retina::Reason::none,
             {refined.map_T_frame, refined.covariance.topLeftCorner<3, 3>()},
             match.score,
             refined.ncc,
             refined.sigma};
  }
  return !wide || refined.ncc >= options_.wide_ncc_share * running_ncc_;
}

Localization Localizer::localize(const Frame& frame, const OcclusionMask& mask, const ScanPoints& points,
                                 const OccupancyMap& occupancy, const Mosaic& mosaic, const PosePrediction& predicted)
{
  const View view{frame, mask, mosaic};
  best_ = {};
  best_.reason = retina::Reason::poor_match;
  const auto found = [&](const MatchResult& match, bool wide) {
    return match.reason == retina::Reason::none && confirm(view, match, wide);
  };
  const auto searchWide = [&] {
    few_.assign(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(
                                                     points.size(), static_cast<std::size_t>(options_.wide_points))));
    const double reach = options_.wide_cells * cell_px_;
    const double step = cell_px_ / std::hypot(frame.centre().x(), frame.centre().y());
    return matcher_.search(few_, occupancy, {predicted.map_T_frame, reach, reach, options_.wide_steps * step});
  };
  const MatchResult unmatched{retina::Reason::none, predicted.map_T_frame, 0.0, predicted.covariance};
  if (found(matcher_.match(points, occupancy, predicted), false) || found(searchWide(), true) ||
      found(unmatched, true) || found(relocalizer_.search(points, occupancy, predicted.map_T_frame), true) ||
      best_.reason == retina::Reason::none) {
    relocalizer_.restart();
    running_ncc_ = running_ncc_ > 0.0 ? 0.9 * running_ncc_ + 0.1 * best_.ncc : best_.ncc;
  }
  return best_;
}

}  // namespace eyeslam::tracking
