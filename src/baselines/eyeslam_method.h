// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/baselines/method.h"
#include "eyeslam/tracking/eyeslam_tracker.h"

namespace eyeslam::baselines {

/// EyeSlamTracker as a Method.
class EyeSlamMethod : public Method {
 public:
  explicit EyeSlamMethod(const tracking::TrackerOptions& options) : tracker_(options) {}

  const tracking::TrackResult& track(const cv::Mat& image) override { return tracker_.track(image); }
  void updateMap() override { tracker_.updateMap(); }
  void finishMap() override { tracker_.finishMap(); }
  const retina::VesselMap& vesselMap() override { return tracker_.getVesselMap(); }
  Mosaic mosaic() const override;
  std::vector<cv::Point2f> points() const override { return tracker_.getPoints(); }
  const tracking::EyeSlamTracker* eyeSlam() const override { return &tracker_; }

 private:
  tracking::EyeSlamTracker tracker_;
};

}  // namespace eyeslam::baselines
