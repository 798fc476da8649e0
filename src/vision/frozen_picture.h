// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "eyeslam/tracking/track_result.h"

namespace eyeslam::vision {

/// Keeps a live picture that is the last one again from the tracker: a camera's noise never repeats, so its driver is
/// stuck, and the retina may be anywhere. Not for video files, which may repeat a picture.
///
///   FrozenPicture live;
///   const TrackResult& result = live.track(tracker, image);
///
/// Cost: a copy of the picture; the comparison ends at the first difference. Allocates at the first picture only.
class FrozenPicture {
 public:
  /// @param tracker  has `const TrackResult& track(const cv::Mat&)`
  /// @return the tracker's result, or that of the last new picture as not tracked, for the reason `frozen`
  template <class Tracker>
  const tracking::TrackResult& track(Tracker& tracker, const cv::Mat& image)
  {
    if (repeats(image)) return freeze();
    result_ = tracker.track(image);
    return result_;
  }

  /// Whether the picture is the last one, byte for byte; keeps it for the next call.
  bool repeats(const cv::Mat& image);

 private:
  const tracking::TrackResult& freeze();

  cv::Mat last_;
  tracking::TrackResult result_;
};

}  // namespace eyeslam::vision
