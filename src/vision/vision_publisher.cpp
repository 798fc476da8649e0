// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/vision/vision_publisher.h"

#include <algorithm>

namespace eyeslam::vision {
namespace {

// A map of 1500 x 1200 cells has passed once in 19 s at 30 Hz; 10 kB a frame.
constexpr int kTilesPerFrame = 8;

}  // namespace

// An invalid registration says nothing new about the size of a px: the last valid one stays.
VisionPublisher::VisionPublisher(messaging::Link& link, double um_per_px, double frame_rate)
    : link_(link),
      poses_(link),
      instruments_(link),
      tiles_(link),
      registrations_(link,
                     [this](const messaging::PublishedRegistration& registration, const messaging::MessageHeader&) {
                       if (registration.valid && registration.um_per_px > 0.0) um_per_px_ = registration.um_per_px;
                     }),
      um_per_px_(um_per_px),
      frame_rate_(frame_rate)
{}

void VisionPublisher::publishPose(const messaging::FrameStamp& frame, const tracking::TrackResult& result,
                                  std::uint64_t map_version, std::int64_t utime_sent)
{
  const messaging::MapStamp map{link_.session(), static_cast<std::int64_t>(map_version), um_per_px_};
  const messaging::RetinaMotion motion{result.tracked, result.reason, result.map_T_frame, frame_rate_ * result.velocity,
                                       result.covariance};
  poses_.publish(messaging::RetinaPose{frame, map, motion}, frame.utime, utime_sent);
}

void VisionPublisher::publishInstrument(const messaging::FrameStamp& frame, const tracking::ToolTip& tip,
                                        const tracking::AimingSpot& spot, std::int64_t utime_sent)
{
  messaging::InstrumentSight sight;
  sight.frame = frame;
  if (tip.present) {
    sight.tip = {true, {tip.x_px, tip.y_px}, tip.covariance};
    sight.shaft_angle = tip.shaft_angle;
    sight.shaft_width_px = tip.shaft_width_px;
  }
  if (spot.present) sight.spot = {true, {spot.x_px, spot.y_px}, spot.covariance};
  instruments_.publish(sight, frame.utime, utime_sent);
}

void VisionPublisher::publishTiles(const messaging::FrameStamp& frame, const retina::VesselMap& map,
                                   std::int64_t utime_sent)
{
  const int tiles = std::min(kTilesPerFrame, messaging::MapTileCycle::tiles(map));
  for (int i = 0; i < tiles; ++i) {
    cycle_.next(map, link_.session(), frame.utime, tile_);
    tile_.um_per_px = um_per_px_;
    tiles_.publish(tile_, utime_sent);
  }
}

}  // namespace eyeslam::vision
