// SPDX-License-Identifier: GPL-3.0-or-later
#include "real_time/frame_feed.h"

#include <cmath>
#include <utility>

namespace eyeslam::apps {

FrameFeed::FrameFeed(simulation::EyeCamera camera, const std::string& name, double frames_per_second)
    : camera_(std::move(camera)),
      ring_(name, {camera_.size(), CV_8UC3, frames_per_second}),
      thread_({1000, 0}, [this](const CycleStart&) { return work(); })
{}

void FrameFeed::show(std::optional<simulation::FrameDue> due)
{
  if (due) pending_ = std::make_unique<simulation::FrameDue>(*std::move(due));
  if (pending_ && place_.tryOffer(pending_)) pending_.reset();  // an older one that nobody rendered
}

void FrameFeed::end()
{
  thread_.askToEnd();
  thread_.join();
}

bool FrameFeed::work()
{
  std::unique_ptr<simulation::FrameDue> due;
  if (!place_.take(due) || !due) return true;
  const simulation::RenderedFrame frame = camera_.render(*due);
  remember({due->utime, frame.map_T_frame});
  ring_.write(frame.image, {due->frame, due->utime, std::llround(1e6 * due->exposure)});
  ++frames_;
  return true;
}

void FrameFeed::remember(const Seen& seen)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  seen_.push_back(seen);
  if (seen_.size() > kRemembered) seen_.pop_front();
}

std::optional<retina::Pose2> FrameFeed::truth(std::int64_t utime) const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const Seen& seen : seen_) {
    if (seen.utime == utime) return seen.map_T_frame;
  }
  return std::nullopt;
}

}  // namespace eyeslam::apps
