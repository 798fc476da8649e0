// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "eyeslam/baselines/method.h"
#include "eyeslam/baselines/view_count.h"
#include "eyeslam/tracking/cross_vessel_smoother.h"
#include "eyeslam/tracking/masked_frame.h"
#include "eyeslam/tracking/occupancy_map.h"
#include "eyeslam/tracking/point_selector.h"
#include "eyeslam/tracking/pose_filter.h"
#include "eyeslam/tracking/scan_matcher.h"
#include "eyeslam/tracking/spurious_detection_filter.h"
#include "eyeslam/tracking/structure_check.h"
#include "eyeslam/tracking/vessel_tracer.h"

namespace eyeslam::baselines {

/// EyeSLAM as the paper describes it (facts A1): vessels traced after Can with wider turning, colour, bloom and rim
/// tests, smoothing across the vessel, at most 500 random points, correlative scan matching, a constant-velocity Kalman
/// filter, an occupancy grid that decays in view and grows. No refinement, no mosaic, no scale. The published map is
/// the grid's cells above the threshold. Two liberties: the search is exact over its window (the paper's is greedy),
/// and cells are one frame px.
class PaperMethod : public Method {
 public:
  explicit PaperMethod(const tracking::TrackerOptions& options);

  const tracking::TrackResult& track(const cv::Mat& image) override;
  void updateMap() override;
  const retina::VesselMap& vesselMap() override;

 private:
  retina::Reason observe(const cv::Mat& image);
  tracking::MatchResult localize(const tracking::PosePrediction& predicted);
  const tracking::TrackResult& accept(const tracking::PoseEstimate& map_T_frame, double score);
  const tracking::TrackResult& refuse(retina::Reason why);

  tracking::TrackerOptions options_;
  tracking::MaskedFrame masked_;
  tracking::VesselTracer tracer_;
  tracking::SpuriousDetectionFilter spurious_filter_;
  tracking::CrossVesselSmoother smoother_;
  tracking::StructureCheck structure_;
  tracking::PointSelector selector_;
  tracking::ScanMatcher matcher_;
  tracking::PoseFilter filter_;
  tracking::OccupancyMap grid_;
  ViewCount views_;
  tracking::VesselPoints traced_;
  tracking::ScanPoints points_;      // for matching
  tracking::ScanPoints all_points_;  // for the map
  retina::Pose2 map_T_frame_;        // frame px
  tracking::TrackResult result_;
  retina::VesselMap map_;
};

}  // namespace eyeslam::baselines
