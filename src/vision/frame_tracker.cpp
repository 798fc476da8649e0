// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/vision/frame_tracker.h"

namespace eyeslam::vision {

SeenFrame FrameTracker::look(const cv::Mat& image, const messaging::FrameStamp& stamp)
{
  const tracking::TrackResult& result = live_.track(tracker_, image);
  frozen_ = result.reason == retina::Reason::frozen;
  if (frozen_) return {stamp, result, {}, {}};
  return {stamp, result, tracker_.getToolTip(), tracker_.getAimingSpot()};
}

void FrameTracker::updateMap()
{
  if (!frozen_) tracker_.updateMap();
}

void FrameTracker::tell(const SeenFrame& seen, std::int64_t utime_sent)
{
  publisher_.publishPose(seen.stamp, seen.result, tracker_.getVesselMap().version, utime_sent);
  publisher_.publishInstrument(seen.stamp, seen.tip, seen.spot, utime_sent);
}

void FrameTracker::tellMap(const messaging::FrameStamp& stamp, std::int64_t utime_sent)
{
  publisher_.publishTiles(stamp, tracker_.getVesselMap(), utime_sent);
}

}  // namespace eyeslam::vision
