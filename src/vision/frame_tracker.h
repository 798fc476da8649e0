// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/messaging/link.h"
#include "eyeslam/tracking/eyeslam_tracker.h"
#include "eyeslam/vision/frozen_picture.h"
#include "eyeslam/vision/vision_publisher.h"

namespace eyeslam::vision {

/// What one frame gave, until it is told.
struct SeenFrame {
  messaging::FrameStamp stamp;
  tracking::TrackResult result;
  tracking::ToolTip tip;
  tracking::AimingSpot spot;
};

/// The tracker on live frames and what it tells of them, step by step: in which order they are taken, and when, is the
/// caller's, for that differs between a live program, a trial and a replay. A picture that repeats the last one is kept
/// from the tracker, and nothing is seen in it.
class FrameTracker {
 public:
  /// @param link, um_per_px, frame_rate  as of VisionPublisher
  FrameTracker(const tracking::TrackerOptions& options, messaging::Link& link, double um_per_px, double frame_rate)
      : tracker_(options), publisher_(link, um_per_px, frame_rate)
  {}

  /// Localizes a frame.
  SeenFrame look(const cv::Mat& image, const messaging::FrameStamp& stamp);
  /// A slice of the published map, after the frame that was looked at last.
  void updateMap();
  /// RETINA_POSE and TOOL_TIP, with the map as it is now.
  void tell(const SeenFrame& seen, std::int64_t utime_sent);
  /// The next tiles of VESSEL_MAP.
  void tellMap(const messaging::FrameStamp& stamp, std::int64_t utime_sent);

  const tracking::EyeSlamTracker& tracker() const { return tracker_; }
  void setFrameRate(double frame_rate) { publisher_.setFrameRate(frame_rate); }

 private:
  tracking::EyeSlamTracker tracker_;
  FrozenPicture live_;
  VisionPublisher publisher_;
  bool frozen_ = false;
};

}  // namespace eyeslam::vision
