// SPDX-License-Identifier: GPL-3.0-or-later
#include "track/message_publisher.h"

#include <algorithm>
#include <optional>
#include <random>

#include "command_line/clocks.h"
#include "command_line/version.h"
#include "eyeslam/tracking/eyeslam_tracker.h"

namespace eyeslam::apps {
namespace {

// A map of 1500 x 1200 cells has passed once in 19 s at 30 Hz; 10 kB a frame.
constexpr int kTilesPerFrame = 8;

// Not 0, and different in every run.
std::int64_t newSession()
{
  std::random_device random;
  const std::uint64_t bits = (static_cast<std::uint64_t>(random()) << 32U) | random();
  return static_cast<std::int64_t>(bits >> 1U) | 1;
}

std::optional<messaging::Key> keyIn(const std::string& file)
{
  if (file.empty()) return {};
  return messaging::readKey(file);
}

}  // namespace

MessagePublisher::MessagePublisher(const std::string& url, const std::string& key_file, double um_per_px,
                                   double frame_rate, const std::string& configuration,
                                   const std::string& configuration_hash)
    : link_(url, newSession(), keyIn(key_file)), um_per_px_(um_per_px), frame_rate_(frame_rate)
{
  mark(mark_t::START, configuration, configuration_hash);
}

void MessagePublisher::mark(std::int16_t kind, const std::string& configuration, const std::string& configuration_hash)
{
  mark_t message{};
  message.utime = utimeNow();
  message.kind = kind;
  message.sender = "eyeslam-track";
  message.version = kVersion;
  message.configuration = configuration;
  message.configuration_hash = configuration_hash;
  marks_.publish(message, message.utime);
}

void MessagePublisher::onRead(const files::VideoFrame&) { utime_read_ = utimeNow(); }

void MessagePublisher::onFrame(const files::VideoFrame& frame, const tracking::TrackResult& result,
                               baselines::Method& method)
{
  const messaging::FrameStamp stamp{utime_read_, frame.number, 0.0};
  const retina::VesselMap& map = method.vesselMap();
  publishPose(stamp, result, map);
  if (const tracking::EyeSlamTracker* tracker = method.eyeSlam()) publishTip(stamp, tracker->getToolTip());
  publishTiles(stamp, map);
}

void MessagePublisher::publishPose(const messaging::FrameStamp& stamp, const tracking::TrackResult& result,
                                   const retina::VesselMap& map)
{
  const messaging::MapStamp map_stamp{link_.session(), static_cast<std::int64_t>(map.version), um_per_px_};
  const messaging::RetinaMotion motion{result.tracked, result.reason, result.map_T_frame, frame_rate_ * result.velocity,
                                       result.covariance};
  poses_.publish(messaging::RetinaPose{stamp, map_stamp, motion}, stamp.utime, utimeNow());
}

void MessagePublisher::publishTip(const messaging::FrameStamp& stamp, const tracking::ToolTip& tip)
{
  messaging::InstrumentSight sight;
  sight.frame = stamp;
  if (tip.present) {
    sight.tip = {true, {tip.x_px, tip.y_px}, tip.covariance};
    sight.shaft_angle = tip.shaft_angle;
    sight.shaft_width_px = tip.shaft_width_px;
  }
  tips_.publish(sight, stamp.utime, utimeNow());
}

void MessagePublisher::publishTiles(const messaging::FrameStamp& stamp, const retina::VesselMap& map)
{
  const int tiles = std::min(kTilesPerFrame, messaging::MapTileCycle::tiles(map));
  for (int i = 0; i < tiles; ++i) {
    cycle_.next(map, link_.session(), stamp.utime, tile_);
    tile_.um_per_px = um_per_px_;
    tiles_.publish(tile_, utimeNow());
  }
}

void MessagePublisher::finish() { mark(mark_t::STOP, "", ""); }

}  // namespace eyeslam::apps
