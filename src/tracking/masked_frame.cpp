// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/masked_frame.h"

namespace eyeslam::tracking {

using retina::Reason;

MaskedFrame::MaskedFrame(const TrackerOptions& options)
    : least_visible_(options.localizer.least_visible),
      least_red_(options.localizer.least_red),
      frame_(options.frame),
      mask_(options.occlusion)
{}

Reason MaskedFrame::assign(const cv::Mat& image)
{
  if (const Reason why = frame_.assign(image); why != Reason::none) return why;
  mask_.update(frame_);
  if (isDark()) return Reason::blackout;
  frame_.normalise(mask_);
  return Reason::none;
}

bool MaskedFrame::isDark() const { return mask_.medianRed() < least_red_ || mask_.visibleFraction() < least_visible_; }

const TrackResult& refuseFrame(TrackResult& result, Reason why, int points)
{
  result.tracked = false;
  result.reason = why;
  result.velocity.setZero();
  result.points = points;
  result.score = 0.0;
  return result;
}

}  // namespace eyeslam::tracking
