// SPDX-License-Identifier: GPL-3.0-or-later
#include "track/overlay_writer.h"

#include "eyeslam/tracking/eyeslam_tracker.h"

namespace eyeslam::apps {
namespace {

// Putting the mosaic's picture together costs more than drawing it, and it changes slowly.
constexpr std::int64_t kMosaicPeriod = 10;  // frames

}  // namespace

void OverlayWriter::onFrame(const files::VideoFrame& frame, const tracking::TrackResult& result,
                            baselines::Method& method)
{
  if (pictures_++ % kMosaicPeriod == 0) mosaic_ = method.mosaic();
  const tracking::EyeSlamTracker* const tracker = method.eyeSlam();
  const std::vector<cv::Point2f> points = method.points();
  video_.add(overlay_.draw({frame.image, points, method.vesselMap(), mosaic_.picture, mosaic_.origin,
                            mosaic_.px_per_pixel, result, tracker ? tracker->getToolTip() : tracking::ToolTip{},
                            frame.t, tracker ? tracker->getAimingSpot() : tracking::AimingSpot{}}));
}

}  // namespace eyeslam::apps
