// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/tracking/track_result.h"

namespace eyeslam::vision {

/// "Vision" of contracts, section 4: tells of each frame where the view is, where the instrument is, and a part of the
/// map. Its map's id is the link's session. The same live and in lock step: whoever owns the link drains it and says
/// what time it is.
///
///   VisionPublisher publisher(link, um_per_px, frame_rate);
///   while (read(image, stamp)) {
///     link.drain(now);                                                  // a REGISTRATION may bring its um per px
///     const TrackResult& result = tracker.track(image);
///     publisher.publishPose(stamp, result, tracker.getVesselMap().version, utime_now);
///     publisher.publishInstrument(stamp, tracker.getToolTip(), tracker.getAimingSpot(), utime_now);
///     tracker.updateMap();
///     publisher.publishTiles(stamp, tracker.getVesselMap(), utime_now);
///   }
class VisionPublisher {
 public:
  /// @param um_per_px   of full-resolution map px, 0 = unknown; counts until a valid registration is heard
  /// @param frame_rate  of the frames that are tracked, 1/s: makes a velocity per frame one per second
  VisionPublisher(messaging::Link& link, double um_per_px, double frame_rate);

  /// RETINA_POSE.
  /// @param map_version  of the map that the frame was matched with
  void publishPose(const messaging::FrameStamp& frame, const tracking::TrackResult& result, std::uint64_t map_version,
                   std::int64_t utime_sent);
  /// TOOL_TIP.
  void publishInstrument(const messaging::FrameStamp& frame, const tracking::ToolTip& tip,
                         const tracking::AimingSpot& spot, std::int64_t utime_sent);
  /// The next few tiles as VESSEL_MAP, so that the whole map passes again and again.
  void publishTiles(const messaging::FrameStamp& frame, const retina::VesselMap& map, std::int64_t utime_sent);

  /// Of the last valid registration heard, else the given one; um, 0 = unknown.
  double umPerPx() const { return um_per_px_; }
  /// Of the frames that are tracked, 1/s, from now on: a live source may leave frames out.
  void setFrameRate(double frame_rate) { frame_rate_ = frame_rate; }

 private:
  messaging::Link& link_;
  messaging::Publisher<retina_pose_t> poses_;
  messaging::Publisher<tool_tip_t> instruments_;
  messaging::Publisher<vessel_map_t> tiles_;
  messaging::Subscription<registration_t> registrations_;
  messaging::MapTileCycle cycle_;
  vessel_map_t tile_{};
  double um_per_px_;
  double frame_rate_;
};

}  // namespace eyeslam::vision
