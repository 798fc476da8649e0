// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/features2d.hpp>
#include <optional>
#include <vector>

#include "eyeslam/baselines/method.h"
#include "eyeslam/tracking/masked_frame.h"

namespace eyeslam::baselines {

/// What a user of OpenCV would try first: keypoints with descriptors (SIFT, ORB), matched to the nearest keyframe, a
/// similarity by RANSAC. It gets our contrast picture and our masks: on the raw green it loses the view. A frame that
/// moved on becomes a keyframe. No map.
class FeatureMethod : public Method {
 public:
  /// @param features  detector and descriptor
  /// @param norm      of its descriptors: cv::NORM_L2 or cv::NORM_HAMMING
  FeatureMethod(const tracking::TrackerOptions& options, cv::Ptr<cv::Feature2D> features, int norm);

  const tracking::TrackResult& track(const cv::Mat& image) override;
  const retina::VesselMap& vesselMap() override { return no_map_; }

 private:
  struct Keyframe {
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    retina::Pose2 map_T_keyframe;  // frame px
  };
  struct Fit {
    retina::Pose2 keyframe_T_frame;
    int inliers = 0;
  };

  retina::Reason observe(const cv::Mat& image);
  const Keyframe& nearestKeyframe() const;
  std::optional<Fit> fitTo(const Keyframe& keyframe);
  const tracking::TrackResult& accept(const retina::Pose2& map_T_frame, int inliers);

  tracking::MaskedFrame masked_;
  cv::Ptr<cv::Feature2D> features_;
  cv::BFMatcher matcher_;
  std::vector<Keyframe> keyframes_;
  Keyframe now_;
  cv::Mat picture_, visible_;
  retina::Pose2 map_T_frame_;  // of the last tracked frame, frame px
  tracking::TrackResult result_;
  retina::VesselMap no_map_;
};

}  // namespace eyeslam::baselines
