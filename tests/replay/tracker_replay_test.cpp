// SPDX-License-Identifier: GPL-3.0-or-later
// Logs with a video are tracked again: the same bytes from the same pictures, and differences from others.
#include "eyeslam/replay/tracker_replay.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/replay/message_types.h"
#include "eyeslam/vision/frame_rate.h"
#include "support/broken_messages.h"
#include "support/filmed_vision.h"
#include "support/sanitized.h"

namespace eyeslam::replay {
namespace {

using support::FilmedVision;

const FilmedVision& filmed()
{
  static const FilmedVision vision;
  return vision;
}

struct Replayed {
  Comparison comparison;
  TrackerFindings findings;
  std::vector<std::string> heard;  // channel and bytes of each message, where they were asked for

  const ChannelComparison& of(const std::string& channel) const
  {
    for (const ChannelComparison& found : comparison.channels())
      if (found.channel == channel) return found;
    throw std::out_of_range(channel);
  }
};

TrackerReplayOptions usual()
{
  TrackerReplayOptions options;
  options.tracker = FilmedVision::options();
  options.frame_rate = FilmedVision::kRate;
  return options;
}

std::string wordOf(const SortedEvent& event)
{
  return std::string(event.event.channel) +
         std::string(reinterpret_cast<const char*>(event.event.data), event.event.size);
}

Replayed replayed(const std::string& log_path, const std::string& video_path, const TrackerReplayOptions& options,
                  bool listens = false, std::int64_t shift = 0)
{
  Replayed result;
  SideVideo video(video_path, shift);
  SortedLog log(log_path);
  TrackerReplay::Each each;
  if (listens) each = [&](const SortedEvent& event) { result.heard.push_back(wordOf(event)); };
  TrackerReplay replay(options, video, result.comparison, each);
  while (const auto event = log.next()) replay.take(*event);
  replay.finish();
  result.findings = replay.findings();
  return result;
}

TEST(TrackerReplay, SaysTheSameBytesFromTheSamePictures)
{
  const Replayed again = replayed(filmed().path, filmed().film("same.mkv", filmed().pictures), usual());
  EXPECT_TRUE(again.comparison.isIdentical());
  EXPECT_EQ(again.of("RETINA_POSE").identical, FilmedVision::kFrames);
  EXPECT_EQ(again.of("TOOL_TIP").identical, FilmedVision::kFrames);
  EXPECT_GT(again.of("VESSEL_MAP").identical, 500);
  EXPECT_EQ(again.findings.frames, FilmedVision::kFrames);
  EXPECT_EQ(again.findings.missing, 0);
}

TEST(TrackerReplay, HandsOnTheLogWithWhatItComputedInItsPlace)
{
  const Replayed again = replayed(filmed().path, filmed().film("handed.mkv", filmed().pictures), usual(), true);
  std::vector<std::string> recorded;
  SortedLog log(filmed().path);
  while (const auto event = log.next()) recorded.push_back(wordOf(*event));
  EXPECT_TRUE(again.heard == recorded);
}

TEST(TrackerReplay, TellsWhereAChangedBlockBeganToMatter)
{
  constexpr std::size_t kChanged = 100;
  std::vector<cv::Mat> pictures = filmed().pictures;
  pictures[kChanged] = pictures[kChanged].clone();
  cv::rectangle(pictures[kChanged], cv::Rect(100, 60, 64, 64), cv::Scalar(90, 90, 90), cv::FILLED);
  const Replayed again = replayed(filmed().path, filmed().film("changed.mkv", pictures), usual());
  const ChannelComparison& poses = again.of("RETINA_POSE");
  ASSERT_TRUE(poses.first.has_value());
  EXPECT_FALSE(again.comparison.isIdentical());
  EXPECT_LT(poses.identical, FilmedVision::kFrames);
  EXPECT_GE(poses.identical, static_cast<std::int64_t>(kChanged));
  // The frame's messages went out 16 to 30 ms after the middle of its exposure.
  const std::int64_t middle = support::kLogStart + std::llround(1e6 * kChanged / FilmedVision::kRate);
  EXPECT_GE(poses.first->utime, middle + 16'000);
  EXPECT_LE(poses.first->utime, middle + 31'000);
}

TEST(TrackerReplay, AsksWhatAnotherConfigurationWouldHaveSeen)
{
  TrackerReplayOptions options = usual();
  options.tracker.frame.scale = 0.5;
  const Replayed again = replayed(filmed().path, filmed().film("what_if.mkv", filmed().pictures), options);
  EXPECT_EQ(again.of("RETINA_POSE").compared, FilmedVision::kFrames);
  EXPECT_FALSE(again.of("RETINA_POSE").isIdentical());
}

// A pose and its tip may have been lost on their way to a log: the picture is tracked, or all later ones would differ.
TEST(TrackerReplay, TracksPicturesOfPosesThatTheLogLost)
{
  support::WrittenLog partial;
  SortedLog log(filmed().path);
  while (const auto event = log.next()) {
    const bool vision = event->event.channel == "RETINA_POSE" || event->event.channel == "TOOL_TIP";
    const std::int64_t number = vision ? headerOf(event->event).seq : -1;
    const bool lost = number < 30 || (number >= 90 && number < 93);
    const bool kept = vision && !lost;
    if (!kept) continue;
    partial.add(std::string(event->event.channel),
                support::Bytes(event->event.data, event->event.data + event->event.size), event->event.utime);
  }
  TrackerReplayOptions options = usual();
  const Replayed again = replayed(partial.finish(), filmed().film("partial.mkv", filmed().pictures), options);
  EXPECT_EQ(again.findings.lost, 33);
  EXPECT_EQ(again.findings.frames, FilmedVision::kFrames);
  EXPECT_EQ(again.of("TOOL_TIP").compared, FilmedVision::kFrames - 33);
  EXPECT_EQ(again.of("TOOL_TIP").identical, FilmedVision::kFrames - 33);
  EXPECT_EQ(again.of("TOOL_TIP").extra, 3);
}

TEST(TrackerReplay, SaysWhichPosesHaveNoPictureAndWhichTimesCannotBe)
{
  support::WrittenLog odd;
  SortedLog log(filmed().path);
  while (const auto event = log.next()) {
    if (event->event.channel != "RETINA_POSE") continue;
    retina_pose_t pose{};
    ASSERT_TRUE(messaging::decode(event->event.data, event->event.size, pose));
    if (pose.seq == 40) pose.utime = 0;
    if (pose.seq == 50) pose.utime = support::kLogStart + std::llround(1e6 * 49 / FilmedVision::kRate);
    if (pose.seq == 60) pose.utime -= 20000;
    odd.add(pose, event->event.utime);
  }
  const std::vector<cv::Mat> some(filmed().pictures.begin(), filmed().pictures.begin() + 170);
  const Replayed again = replayed(odd.finish(), filmed().film("short.mkv", some), usual());
  EXPECT_EQ(again.findings.missing, FilmedVision::kFrames - 170);
  EXPECT_EQ(again.findings.times_missing, 1);
  EXPECT_EQ(again.findings.times_repeated, 1);
  EXPECT_EQ(again.findings.times_backwards, 1);
  EXPECT_EQ(again.findings.first_bad_time, 40);
}

// A live tracker and its log. @param late  frames that it has seen since a registration was sent when it reads that
std::string liveLog(support::WrittenLog& log, int frames, int late)
{
  constexpr int kSent = 20;
  messaging::Link link("memq://", FilmedVision::kSession, std::nullopt);
  messaging::EventTap tap(link, [&](const messaging::TappedEvent& event) {
    if (event.channel == "REGISTRATION") return;  // it went to the log when it was sent
    log.add(std::string(event.channel), support::Bytes(event.data, event.data + event.size), event.utime);
  });
  vision::FrameTracker tracker(FilmedVision::options(), link, 0.0, FilmedVision::kRate);
  vision::FrameRate rate(FilmedVision::kRate);
  registration_t scale = support::headed<registration_t>(0, 0, FilmedVision::kSession + 1);
  scale.valid = true;
  scale.um_per_px = 4.5;
  for (int frame = 0; frame < frames; ++frame) {
    const messaging::FrameStamp stamp{support::kLogStart + std::llround(1e6 * frame / FilmedVision::kRate), frame,
                                      0.004};
    const std::int64_t ready = stamp.utime + 6000;
    tap.setTime(ready);
    if (frame == kSent) {
      scale.utime = scale.utime_sent = ready - 5000;
      log.add(scale, scale.utime_sent);
    }
    if (frame == kSent + late) {
      const support::Bytes bytes = support::encodedMessage(scale);
      link.send("REGISTRATION", bytes.data(), bytes.size());
      link.drain({ready, ready});
    }
    tracker.setFrameRate(rate.follow(stamp.utime));
    const vision::SeenFrame seen = tracker.look(filmed().pictures[static_cast<std::size_t>(frame)], stamp);
    tracker.tell(seen, ready);
    tracker.updateMap();
    tracker.tellMap(stamp, ready);
    link.drain({ready, ready});
  }
  return log.finish();
}

TEST(TrackerReplay, LiveARegistrationCountsFromThePoseThatSaysSo)
{
  constexpr int kFrames = 40;
  TrackerReplayOptions options = usual();
  options.order = TrackerOrder::live;
  const std::vector<cv::Mat> some(filmed().pictures.begin(), filmed().pictures.begin() + kFrames);
  const std::string film = filmed().film("live.mkv", some);
  for (const int late : {0, 1, 3}) {
    support::WrittenLog log;
    const Replayed again = replayed(liveLog(log, kFrames, late), film, options);
    EXPECT_TRUE(again.comparison.isIdentical()) << late << " frames late";
    EXPECT_EQ(again.of("RETINA_POSE").identical, kFrames);
    EXPECT_EQ(again.of("RETINA_POSE").compared, kFrames);
  }
}

TEST(TrackerReplay, LeavesMessagesOfNoSessionAlone)
{
  support::WrittenLog odd;
  SortedLog log(filmed().path);
  odd.add(support::headed<tool_tip_t>(support::kLogStart, 0, 0), support::kLogStart);
  odd.add(support::headed<retina_pose_t>(support::kLogStart, 0, 0), support::kLogStart);
  while (const auto event = log.next()) {
    odd.add(std::string(event->event.channel), support::Bytes(event->event.data, event->event.data + event->event.size),
            event->event.utime);
  }
  odd.finish();
  const std::vector<cv::Mat> some(filmed().pictures.begin(), filmed().pictures.begin() + 30);
  for (const TrackerOrder order : {TrackerOrder::lock_step, TrackerOrder::live}) {
    TrackerReplayOptions options = usual();
    options.order = order;
    const Replayed again = replayed(odd.path("log.lcm"), filmed().film("odd.mkv", some), options);
    EXPECT_EQ(again.findings.frames, 30);
    EXPECT_EQ(again.findings.other_runs, 1);
  }
}

TEST(TrackerReplay, ComesToAnEndWithBrokenMessages)
{
  std::mt19937 random(8);
  const std::string film = filmed().film("broken.mkv", filmed().pictures);
  for (int i = 0; i < support::cases(6); ++i) {
    support::WrittenLog odd;
    SortedLog log(filmed().path);
    while (const auto event = log.next()) {
      std::string bytes(reinterpret_cast<const char*>(event->event.data), event->event.size);
      if (random() % 20 == 0) support::breakMessage(bytes, random);
      odd.add(std::string(event->event.channel), support::Bytes(bytes.begin(), bytes.end()), event->event.utime);
    }
    const Replayed again = replayed(odd.finish(), film, usual());
    EXPECT_GT(again.findings.frames, 0) << "case " << i;
  }
}

}  // namespace
}  // namespace eyeslam::replay
