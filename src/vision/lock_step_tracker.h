// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <opencv2/core.hpp>

#include "eyeslam/vision/frame_tracker.h"

namespace eyeslam::vision {

/// The tracker in lock step: a frame is tracked at once, and its messages wait until a camera and a computer of the
/// wanted latency would have sent them. Given the same pictures and times it sends the same bytes: in a trial and in
/// the replay of its log.
class LockStepTracker {
 public:
  /// @param link, um_per_px, frame_rate  as of VisionPublisher
  LockStepTracker(const tracking::TrackerOptions& options, messaging::Link& link, double um_per_px, double frame_rate)
      : frames_(options, link, um_per_px, frame_rate)
  {}

  /// Tracks a frame and works on the map.
  /// @param ready  us since 1970: when its messages may go out, after those of the frames before it
  /// @return valid until the next `look` or `send`
  const SeenFrame& look(const cv::Mat& image, const messaging::FrameStamp& stamp, std::int64_t ready);
  /// Sends what is ready.
  void send(std::int64_t utime);

  const tracking::EyeSlamTracker& tracker() const { return frames_.tracker(); }

 private:
  struct Waiting {
    std::int64_t ready = 0;
    SeenFrame seen;
  };

  FrameTracker frames_;
  std::deque<Waiting> waiting_;
};

}  // namespace eyeslam::vision
