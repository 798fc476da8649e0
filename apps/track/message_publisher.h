// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "eyeslam/mark_t.hpp"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/retina_messages.h"
#include "track/frame_observer.h"

namespace eyeslam::apps {

/// `--lcm`: this program as the "vision" of contracts, section 4. A frame's time is the time at which it was read.
class MessagePublisher : public FrameObserver {
 public:
  /// @param url            of LCM; empty = LCM_DEFAULT_URL
  /// @param key_file       empty: unsigned, and only within this computer
  /// @param frame_rate     nominal, 1/s: makes a velocity per frame one per second
  /// @param configuration  YAML, for the log
  /// @throws std::runtime_error  the key or the URL cannot be used
  MessagePublisher(const std::string& url, const std::string& key_file, double um_per_px, double frame_rate,
                   const std::string& configuration, const std::string& configuration_hash);

  void onRead(const files::VideoFrame& frame) override;
  void onFrame(const files::VideoFrame& frame, const tracking::TrackResult& result, baselines::Method& method) override;
  void finish() override;

 private:
  void mark(std::int16_t kind, const std::string& configuration, const std::string& configuration_hash);
  void publishPose(const messaging::FrameStamp& stamp, const tracking::TrackResult& result,
                   const retina::VesselMap& map);
  void publishTip(const messaging::FrameStamp& stamp, const tracking::ToolTip& tip);
  void publishTiles(const messaging::FrameStamp& stamp, const retina::VesselMap& map);

  messaging::Link link_;
  messaging::Publisher<mark_t> marks_{link_};
  messaging::Publisher<retina_pose_t> poses_{link_};
  messaging::Publisher<tool_tip_t> tips_{link_};
  messaging::Publisher<vessel_map_t> tiles_{link_};
  messaging::MapTileCycle cycle_;
  vessel_map_t tile_{};
  double um_per_px_;
  double frame_rate_;
  std::int64_t utime_read_ = 0;
};

}  // namespace eyeslam::apps
