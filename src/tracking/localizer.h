// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "eyeslam/tracking/alignment_template.h"
#include "eyeslam/tracking/dense_search.h"
#include "eyeslam/tracking/masked_contrast.h"
#include "eyeslam/tracking/mosaic.h"
#include "eyeslam/tracking/refiner.h"
#include "eyeslam/tracking/relocalizer.h"
#include "eyeslam/tracking/scan_matcher.h"
#include "eyeslam/tracking/smear_model.h"
#include "eyeslam/tracking/tracker_options.h"

namespace eyeslam::tracking {

/// Where a frame lies in the map, or why that could not be said.
struct Localization {
  retina::Reason reason = retina::Reason::none;
  PoseEstimate pose;
  double score = 0.0;  ///< of the match, [0, 1]
  double ncc = 0.0;    ///< frame against mosaic
  double sigma = 0.0;  ///< robust deviation of frame from mosaic, contrast units
};

/// Localization by scan matching, refined and verified against the mosaic. From the cheapest to the dearest search:
/// around the prediction, a wide window, the smeared picture, the whole map; the first answer that the mosaic confirms
/// is taken (tracker study, 2.8 to 2.11).
class Localizer {
 public:
  explicit Localizer(const TrackerOptions& options);

  /// Takes the memory for frames of this size, once.
  void reserve(const cv::Size& frame);
  /// Uses a frame that cannot be localized (a blackout) to prepare the search of the whole map.
  void prepare(const OccupancyMap& occupancy);
  void restart();
  /// @param points     chosen points of the frame, centred frame px
  /// @param last_pose  of the last frame that was localized: the view has moved since
  /// @param freedom    whether the scale is estimated as well
  Localization localize(const MaskedContrast& frame, const ScanPoints& points, const OccupancyMap& occupancy,
                        const Mosaic& mosaic, const PosePrediction& predicted, const retina::Pose2& last_pose,
                        Freedom freedom);

 private:
  struct View;  // what all searches of one frame share
  Refinement align(const View& view, const retina::Pose2& start);
  bool keep(const View& view, const Refinement& refined, double score);
  bool confirm(const View& view, const retina::Pose2& start, double score)
  {
    return keep(view, align(view, start), score);
  }
  bool isConfirmed(const Refinement& refined) const;
  bool decide(const View& view);
  bool matchNear(const View& view);
  bool matchWide(const View& view);
  bool matchDense(const View& view);
  bool matchAnywhere(const View& view);

  LocalizerOptions options_;
  PoseUncertaintyOptions uncertainty_;
  double cell_px_;
  ScanMatcher matcher_;
  Relocalizer relocalizer_;
  DenseSearch dense_search_;
  Refiner refiner_;
  SmearModel smear_model_;
  AlignmentTemplate template_;
  ScanPoints few_;
  Localization best_;
  double running_ncc_ = 0.0;
  int lost_frames_ = 0;   // refused here since the last confirmed one
  bool refuted_ = false;  // lost for long, and the mosaic shows that vessel points cannot tell the place
};

}  // namespace eyeslam::tracking
