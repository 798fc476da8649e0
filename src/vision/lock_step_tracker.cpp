// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/vision/lock_step_tracker.h"

namespace eyeslam::vision {

const SeenFrame& LockStepTracker::look(const cv::Mat& image, const messaging::FrameStamp& stamp, std::int64_t ready)
{
  waiting_.push_back({ready, frames_.look(image, stamp)});
  frames_.updateMap();
  return waiting_.back().seen;
}

void LockStepTracker::send(std::int64_t utime)
{
  while (!waiting_.empty() && waiting_.front().ready <= utime) {
    frames_.tell(waiting_.front().seen, utime);
    frames_.tellMap(waiting_.front().seen.stamp, utime);
    waiting_.pop_front();
  }
}

}  // namespace eyeslam::vision
