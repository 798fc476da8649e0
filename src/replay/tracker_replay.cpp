// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/tracker_replay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/replay/todays_type.h"
#include "eyeslam/vision/frame_rate.h"

namespace eyeslam::replay {
namespace {

constexpr std::string_view kPoseChannel = "RETINA_POSE", kTipChannel = "TOOL_TIP", kMapChannel = "VESSEL_MAP",
                           kScaleChannel = "REGISTRATION";
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kPatience_us = 2'000'000;  // for the next frame: latency and period are a second together
constexpr std::size_t kMostComputed = 4096;       // messages without a recorded one, a channel
constexpr std::int64_t kMostAfterTheLast = 64;    // frames
constexpr double kLongestExposure_s = 1.0;
constexpr std::size_t kTimeSentAt = 16, kTimeBytes = 8, kTagBytes = 16;  // in a message (contracts, section 4)

bool isVision(std::string_view channel)
{
  return channel == kPoseChannel || channel == kTipChannel || channel == kMapChannel;
}

/// Half a microsecond and the rounding of two stamps less: an exposure that ends with a millisecond is over in it.
std::int64_t endOf(const messaging::FrameStamp& stamp) { return stamp.utime + std::llround(5e5 * stamp.exposure) - 1; }

template <class Message>
std::optional<messaging::FrameStamp> stampIn(const std::vector<std::uint8_t>& bytes)
{
  Message message{};
  if (!messaging::decode(bytes.data(), bytes.size(), message)) return std::nullopt;
  const bool usual = message.exposure >= 0.0 && message.exposure <= kLongestExposure_s;
  return messaging::FrameStamp{message.utime, message.frame, usual ? message.exposure : 0.0};
}

}  // namespace

/// Tracker, link and tap: what lives for one session.
struct TrackerReplay::Engine {
  Engine(const TrackerReplayOptions& options, std::int64_t session, messaging::EventTap::Each each)
      : link("memq://", session, std::nullopt), tap(link, std::move(each)), rate(options.frame_rate)
  {
    if (options.order == TrackerOrder::live)
      live.emplace(options.tracker, link, 0.0, options.frame_rate);
    else
      lock_step.emplace(options.tracker, link, 0.0, options.frame_rate);
  }

  messaging::Link link;
  messaging::EventTap tap;
  vision::FrameRate rate;
  std::optional<vision::FrameTracker> live;
  std::optional<vision::LockStepTracker> lock_step;
};

TrackerReplay::TrackerReplay(const TrackerReplayOptions& options, SideVideo& video, Comparison& comparison, Each each)
    : options_(options),
      video_(video),
      comparison_(comparison),
      each_(std::move(each)),
      period_us_(std::llround(1e6 / options.frame_rate))
{
  for (const std::string_view channel : {kPoseChannel, kTipChannel, kMapChannel}) channels_.emplace(channel, Channel());
}

TrackerReplay::~TrackerReplay() = default;

SortedEvent TrackerReplay::Held::event() const
{
  SortedEvent result = sorted;
  result.event = message.event();
  return result;
}

void TrackerReplay::take(const SortedEvent& event)
{
  const bool vision = isVision(event.event.channel), scale = event.event.channel == kScaleChannel;
  if (vision || scale || each_) {
    Held held(event);
    if ((vision || scale) && judgeToday(event.event).standing == Standing::ours) {
      held.header = headerOf(event.event);
      const bool pose = held.message.channel == kPoseChannel;
      if (pose && !engine_ && held.header.session != 0) begin(held.header.session, event.part);
      held.vision = vision && engine_ && held.header.session == session_ && event.part == part_;
      if (pose && !held.vision) ++findings_.other_runs;
    }
    if (held.vision) expectFrame(held);
    held_.push_back(std::move(held));
  }
  while (!held_.empty() && mayProcess(held_.front(), event.utime)) {
    process(held_.front());
    held_.pop_front();
  }
}

void TrackerReplay::finish()
{
  expectFramesAfterTheLast();
  while (!held_.empty()) {
    process(held_.front());
    held_.pop_front();
  }
}

void TrackerReplay::begin(std::int64_t session, std::int64_t part)
{
  session_ = session;
  part_ = part;
  engine_ = std::make_unique<Engine>(options_, session, [this](const messaging::TappedEvent& event) { hear(event); });
}

// A pose and its tip bear the stamp of a frame; either may have been lost on the way to the log.
void TrackerReplay::expectFrame(const Held& held)
{
  last_sent_ = std::max(last_sent_, held.header.utime_sent);
  if (held.message.channel == kMapChannel || held.header.seq < next_number_ ||
      held.header.seq - next_number_ > SideVideo::kMostLost)
    return;
  const auto stamp = held.message.channel == kPoseChannel ? stampIn<retina_pose_t>(held.message.bytes)
                                                          : stampIn<tool_tip_t>(held.message.bytes);
  if (stamp) expect(held.header.seq, *stamp, held.header.utime_sent);
}

void TrackerReplay::expect(std::int64_t number, const messaging::FrameStamp& stamp, std::int64_t ready)
{
  judgeTime(number, stamp.utime);
  if (number == next_number_ && number > 0 && stamp.utime > last_.utime) period_us_ = stamp.utime - last_.utime;
  for (; next_number_ < number; ++next_number_) {
    const std::int64_t before_us = (number - next_number_) * period_us_;
    messaging::FrameStamp guessed = stamp;
    guessed.utime -= before_us;
    guessed.frame -= number - next_number_;
    looks_.push_back({next_number_, guessed, ready - before_us, endOf(guessed), false});
    ++findings_.lost;
  }
  looks_.push_back({number, stamp, ready, endOf(stamp), true});
  last_ = stamp;
  next_number_ = number + 1;
}

void TrackerReplay::judgeTime(std::int64_t number, std::int64_t utime)
{
  const bool missing = utime <= 0, first = next_number_ == 0 || last_.utime <= 0;
  const bool repeated = !missing && !first && utime == last_.utime;
  const bool backwards = !missing && !first && utime < last_.utime;
  findings_.times_missing += missing ? 1 : 0;
  findings_.times_repeated += repeated ? 1 : 0;
  findings_.times_backwards += backwards ? 1 : 0;
  if ((missing || repeated || backwards) && findings_.first_bad_time < 0) findings_.first_bad_time = number;
}

// They were seen, and changed the map, before the last messages went out, though their own did not any more.
void TrackerReplay::expectFramesAfterTheLast()
{
  if (options_.order != TrackerOrder::lock_step || !engine_) return;
  messaging::FrameStamp stamp = last_;
  for (std::int64_t i = 0; i < kMostAfterTheLast; ++i) {
    stamp.utime += period_us_;
    if (endOf(stamp) > last_sent_) return;
    looks_.push_back({next_number_++, stamp, kNever, endOf(stamp), false});
  }
}

// Live, nothing waits. In lock step a message waits until the next frame is known, for it may have been seen before.
bool TrackerReplay::mayProcess(const Held& held, std::int64_t newest) const
{
  if (!held.vision || options_.order == TrackerOrder::live) return true;
  return held.header.utime_sent < endOf(last_) || held.sorted.utime < newest - kPatience_us;
}

void TrackerReplay::process(const Held& held)
{
  place_us_ = held.sorted.since_us;
  if (engine_ && held.message.channel == kScaleChannel && held.header.session != 0) {
    hearScale();
    scale_ = held;
    if (options_.order == TrackerOrder::lock_step) hearScale();
  }
  if (held.vision) {
    if (scale_ && hasHeardScale(held)) hearScale();
    lookUntil(held);
    if (engine_->lock_step && held.message.channel == kPoseChannel) engine_->lock_step->send(held.header.utime_sent);
    drain(held.header.utime_sent);
    compare(held);
  } else if (each_) {
    each_(held.event());
  }
}

void TrackerReplay::hearScale()
{
  if (!scale_) return;
  engine_->link.send(scale_->message.channel, scale_->message.bytes.data(), scale_->message.bytes.size());
  drain(scale_->header.utime_sent);
  scale_.reset();
}

// A log has the order in which messages were sent. When a live tracker came to read one only its next poses tell; on a
// computer with other work that may be a frame later.
bool TrackerReplay::hasHeardScale(const Held& held) const
{
  if (held.header.utime_sent > scale_->header.utime_sent + kPatience_us) return true;
  retina_pose_t pose{};
  registration_t scale{};
  const auto decoded = [](const Held& from, auto& message) {
    return messaging::decode(from.message.bytes.data(), from.message.bytes.size(), message);
  };
  return held.message.channel == kPoseChannel && decoded(held, pose) && decoded(*scale_, scale) &&
         pose.um_per_px == scale.um_per_px;
}

void TrackerReplay::lookUntil(const Held& held)
{
  const bool live = options_.order == TrackerOrder::live;
  if (live && held.message.channel == kMapChannel) return;
  const auto isDue = [&](const Look& due) {
    return live ? due.number <= held.header.seq : due.over <= held.header.utime_sent;
  };
  for (; !looks_.empty() && isDue(looks_.front()); looks_.pop_front()) look(looks_.front());
}

void TrackerReplay::look(const Look& due)
{
  const cv::Mat& image = video_.pictureOf(due.number);
  if (image.empty() && due.ready == kNever) return;
  ++(image.empty() ? findings_.missing : findings_.frames);
  if (engine_->live) return lookLive(due, image);
  engine_->lock_step->send(due.over - 1);  // what the log does not tell of; all else has gone
  engine_->lock_step->look(image, due.stamp, due.ready);
  drain(due.over);
}

void TrackerReplay::lookLive(const Look& due, const cv::Mat& image)
{
  vision::FrameTracker& tracker = *engine_->live;
  tracker.setFrameRate(engine_->rate.follow(due.stamp.utime));
  const vision::SeenFrame seen = tracker.look(image, due.stamp);
  tracker.tell(seen, due.ready);
  tracker.updateMap();
  tracker.tellMap(due.stamp, due.ready);
}

void TrackerReplay::drain(std::int64_t utime)
{
  engine_->tap.setTime(utime);
  engine_->link.drain({utime, utime});
}

void TrackerReplay::hear(const messaging::TappedEvent& event)
{
  const auto found = channels_.find(event.channel);
  if (found == channels_.end()) return;
  const files::LogEvent message{event.number, event.utime, event.channel, event.data, event.size};
  std::deque<Computed>& computed = found->second.computed;
  computed.push_back({headerOf(message).seq, {event.data, event.data + event.size}});
  if (computed.size() > kMostComputed) computed.pop_front();
  if (each_) each_({message, event.utime, place_us_});
}

// Messages are told apart by their numbers.
void TrackerReplay::compare(const Held& held)
{
  Channel& channel = channels_.find(held.message.channel)->second;
  const files::LogEvent recorded = held.event().event;
  const auto eventOf = [&](const Computed& computed) {
    return files::LogEvent{computed.number, recorded.utime, held.message.channel, computed.bytes.data(),
                           computed.bytes.size()};
  };
  std::deque<Computed>& computed = channel.computed;
  for (; !computed.empty() && computed.front().number < held.header.seq; computed.pop_front()) {
    const bool was_lost = options_.order == TrackerOrder::live;  // loggers lose messages
    if (channel.begun && !was_lost) comparison_.extra(eventOf(computed.front()));
  }
  channel.begun = true;
  if (computed.empty() || computed.front().number != held.header.seq) {
    comparison_.missing(recorded);
    return;
  }
  align(held, computed.front().bytes);
  comparison_.compare(recorded, eventOf(computed.front()));
  computed.pop_front();
}

// When a live message was sent, and with which key, is no matter of the tracker's.
void TrackerReplay::align(const Held& recorded, std::vector<std::uint8_t>& bytes) const
{
  if (options_.order != TrackerOrder::live || bytes.size() != recorded.message.bytes.size()) return;
  std::copy_n(recorded.message.bytes.begin() + kTimeSentAt, kTimeBytes, bytes.begin() + kTimeSentAt);
  std::copy(recorded.message.bytes.end() - kTagBytes, recorded.message.bytes.end(), bytes.end() - kTagBytes);
}

}  // namespace eyeslam::replay
