// SPDX-License-Identifier: GPL-3.0-or-later
#include "track/message_publisher.h"

#include <optional>

#include "command_line/clocks.h"
#include "eyeslam/tracking/eyeslam_tracker.h"
#include "eyeslam/tracking/masked_frame.h"
#include "link/program_link.h"

namespace eyeslam::apps {
namespace {

constexpr const char* kProgram = "eyeslam-track";

std::optional<messaging::Key> keyIn(const std::string& file)
{
  if (file.empty()) return {};
  return messaging::readKey(file);
}

}  // namespace

MessagePublisher::MessagePublisher(const std::string& url, const std::string& key_file, double um_per_px,
                                   double frame_rate, const std::string& configuration,
                                   const std::string& configuration_hash)
    : link_(url, newSession(), keyIn(key_file)), vision_(link_, um_per_px, frame_rate), frame_rate_(frame_rate)
{
  sendMark(marks_, mark_t::START, kProgram, {configuration, configuration_hash});
}

void MessagePublisher::onRead(const files::VideoFrame& frame)
{
  const messaging::ReceiveTime now = receiveTime();
  link_.drain(receiveTime);
  vision_.setFrameRate(frame_rate_.follow(frame.utime));
  stamp_ = {frame.utime > 0 ? frame.utime : now.utime, frame.number, frame.exposure};
}

// What the loop waits for goes out before the map is worked on.
void MessagePublisher::onTracked(const files::VideoFrame&, const tracking::TrackResult& result,
                                 baselines::Method& method)
{
  vision_.publishPose(stamp_, result, method.vesselMap().version, utimeNow());
  const tracking::EyeSlamTracker* const tracker = method.eyeSlam();
  if (tracker == nullptr) return;
  if (result.reason == retina::Reason::frozen)  // where it was in the picture before
    vision_.publishInstrument(stamp_, {}, {}, utimeNow());
  else
    vision_.publishInstrument(stamp_, tracker->getToolTip(), tracker->getAimingSpot(), utimeNow());
}

void MessagePublisher::onFailure(const files::VideoFrame& frame, const tracking::TrackResult& result,
                                 baselines::Method& method)
{
  tracking::TrackResult last = result;
  tracking::refuseFrame(last, retina::Reason::record_failed);
  const std::int64_t utime = utimeNow();
  vision_.publishPose({utime, frame.number, 0.0}, last, method.vesselMap().version, utime);
  sendMark(marks_, mark_t::STOP, kProgram, {});
}

void MessagePublisher::onFrame(const files::VideoFrame&, const tracking::TrackResult&, baselines::Method& method)
{
  vision_.publishTiles(stamp_, method.vesselMap(), utimeNow());
}

void MessagePublisher::finish() { sendMark(marks_, mark_t::STOP, kProgram, {}); }

}  // namespace eyeslam::apps
