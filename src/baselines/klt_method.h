// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "eyeslam/baselines/method.h"
#include "eyeslam/tracking/masked_frame.h"

namespace eyeslam::baselines {

/// Corners followed by optical flow (Lucas, Kanade, Tomasi) from frame to frame, a similarity by RANSAC to where they
/// were when they were chosen; chosen anew when few are left. Fast and smooth, but every renewal adds its error, and a
/// jump or a blackout is the end: nothing finds the place again. No map.
class KltMethod : public Method {
 public:
  explicit KltMethod(const tracking::TrackerOptions& options);

  const tracking::TrackResult& track(const cv::Mat& image) override;
  const retina::VesselMap& vesselMap() override { return no_map_; }

 private:
  retina::Reason observe(const cv::Mat& image);
  bool follow();
  void chooseCorners();
  const tracking::TrackResult& accept();

  tracking::MaskedFrame masked_;
  cv::Mat picture_, visible_, last_picture_;
  std::vector<cv::Point2f> chosen_;   // where the corners were when chosen, centred frame px
  std::vector<cv::Point2f> corners_;  // where they are in the last frame, frame px
  retina::Pose2 map_T_chosen_;        // of the frame in which they were chosen, frame px
  retina::Pose2 map_T_frame_;
  tracking::TrackResult result_;
  retina::VesselMap no_map_;
};

}  // namespace eyeslam::baselines
