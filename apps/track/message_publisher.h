// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "eyeslam/mark_t.hpp"
#include "eyeslam/messaging/link.h"
#include "eyeslam/vision/frame_rate.h"
#include "eyeslam/vision/vision_publisher.h"
#include "track/frame_observer.h"

namespace eyeslam::apps {

/// `--lcm`: this program as the "vision" of contracts, section 4. A frame's time is its own where the source knows it,
/// else the time at which it was read.
class MessagePublisher : public FrameObserver {
 public:
  /// @param url            of LCM; empty = LCM_DEFAULT_URL
  /// @param key_file       empty: unsigned, and only within this computer
  /// @param um_per_px      0 = unknown; counts until a valid registration is heard
  /// @param frame_rate     nominal, 1/s: makes a velocity per frame one per second
  /// @param configuration  YAML, for the log
  /// @throws std::runtime_error  the key or the URL cannot be used
  MessagePublisher(const std::string& url, const std::string& key_file, double um_per_px, double frame_rate,
                   const std::string& configuration, const std::string& configuration_hash);

  void onRead(const files::VideoFrame& frame) override;
  void onTracked(const files::VideoFrame& frame, const tracking::TrackResult& result,
                 baselines::Method& method) override;
  void onFrame(const files::VideoFrame& frame, const tracking::TrackResult& result, baselines::Method& method) override;
  /// Tells as the last pose that vision has stopped, and why.
  void onFailure(const files::VideoFrame& frame, const tracking::TrackResult& result,
                 baselines::Method& method) override;
  void finish() override;

 private:
  messaging::Link link_;
  messaging::Publisher<mark_t> marks_{link_};
  vision::VisionPublisher vision_;
  vision::FrameRate frame_rate_;
  messaging::FrameStamp stamp_;  // of the frame that was read last
};

}  // namespace eyeslam::apps
