// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/video_replay.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/replay/recorded_configuration.h"
#include "eyeslam/replay/recorded_trial.h"
#include "eyeslam/replay/todays_type.h"

namespace eyeslam::replay {
namespace {

constexpr const char* kTracker = "eyeslam-track";
constexpr const char* kOverlay = "overlay.";  // keys of the program's pictures, of no matter here
constexpr std::int64_t kTimesAtTheEnd = 2;    // that H.264 leaves out

double rateOf(const SideVideo& video, const std::string& path)
{
  const double rate = video.framesPerSecond();
  if (rate > 0.0 && std::isfinite(rate)) return rate;
  throw ReplayError(fmt::format("{}: says no frame rate; a video of a constant one is wanted", path));
}

tracking::TrackerOptions liveTrackerConfiguration(const std::string& yaml)
{
  std::vector<configuration::Assignment> recorded;
  for (const configuration::Assignment& one : configuration::parseYaml(kTracker, yaml))
    if (one.key.rfind(kOverlay, 0) != 0) recorded.push_back(one);
  return configuration::applied(tracking::TrackerOptions{}, recorded);
}

std::string offsetWarning(const OffsetEstimate& offset, double advised_s)
{
  if (!offset.isCertain()) {
    return fmt::format("the offset of the video is not certain: {:+.1f} ms (correlation {:.2f}, elsewhere {:.2f})",
                       1e3 * offset.offset_s, offset.correlation, offset.second);
  }
  return fmt::format(
      "the video is {:.1f} frames off: its time {:+.4f} s is that of the log; --offset {:.4f} takes it so",
      std::abs(offset.frames()), advised_s, advised_s);
}

}  // namespace

VideoReplay::VideoReplay(VideoReplayOptions options, Comparison& comparison, TrackerReplay::Each each)
    : options_(std::move(options)),
      comparison_(comparison),
      each_(std::move(each)),
      video_(options_.video),
      shift_(std::llround(options_.offset_s.value_or(0.0) * rateOf(video_, options_.video))),
      measured_(video_.framesPerSecond(), shift_)
{
  video_.setShift(shift_);
  video_.onPicture([this](std::int64_t number, const cv::Mat& image) { measured_.addPicture(number, image); });
}

void VideoReplay::take(const SortedEvent& event)
{
  measured_.take(event);
  if (event.event.channel == "MARK") takeMark(event);
  if (replay_) {
    replay_->take(event);
  } else if (each_) {
    each_(event);
  }
}

void VideoReplay::takeMark(const SortedEvent& event)
{
  mark_t mark{};
  judgeToday(event.event);
  if (replay_ || !messaging::decode(event.event.data, event.event.size, mark) || mark.kind != mark_t::START) return;
  if (mark.sender == kTracker) {
    begin(configuration::applied(recordedConfiguration(mark, liveTrackerConfiguration), options_.changes),
          video_.framesPerSecond(), TrackerOrder::live, mark);
  } else if (const auto trial = recordedTrial(mark, options_.changes); trial && !trial->setting.scenario.isManual()) {
    begin(trial->setting.vision.tracker, trial->setting.hardware.camera.fps, TrackerOrder::lock_step, mark);
  }
}

void VideoReplay::begin(const tracking::TrackerOptions& tracker, double frame_rate, TrackerOrder order,
                        const mark_t& mark)
{
  const bool live = order == TrackerOrder::live;
  about_ = fmt::format("tracker of {} {} {}", mark.sender, mark.version, live ? "in real time" : "in lock step");
  replay_.emplace(TrackerReplayOptions{tracker, frame_rate, order}, video_, comparison_, each_);
  for (const char* channel : {"RETINA_POSE", "TOOL_TIP", "VESSEL_MAP"}) comparison_.expect(channel);
}

void VideoReplay::finish()
{
  if (replay_) replay_->finish();
  while (measured_.wantsPictures() && video_.pictures() < VideoOffset::kMostPictures && video_.read()) continue;
  offset_ = measured_.estimate();
}

std::string VideoReplay::lacking() const
{
  if (replay_ && findings().frames > 0) return "";
  if (replay_) return fmt::format("no RETINA_POSE of {}", about_);
  return "no MARK START of eyeslam-trial with an aid, or of eyeslam-track: nothing says how the tracker was set; "
         "the logger must run before the tracker begins";
}

std::optional<double> VideoReplay::advisedOffset() const
{
  if (!offset_) return std::nullopt;
  return static_cast<double>(shift_) / video_.framesPerSecond() + offset_->offset_s;
}

std::vector<std::string> VideoReplay::warnings() const
{
  std::vector<std::string> lines = video_.notices();
  const TrackerFindings found = findings();
  const auto say = [&lines](bool so, std::string line) {
    if (so) lines.push_back(std::move(line));
  };
  say(!video_.failure().empty(), video_.failure());
  say(!offset_, "the offset of the video is not known: too little moves, or was logged");
  if (offset_ && (!offset_->isCertain() || std::abs(offset_->frames()) > 0.5))
    lines.push_back(offsetWarning(*offset_, *advisedOffset()));
  say(video_.timesRepaired() > kTimesAtTheEnd,
      fmt::format("{} pictures of the video have no time of their own, or one that is not later than the one before",
                  video_.timesRepaired()));
  say(found.times_missing + found.times_repeated + found.times_backwards > 0,
      fmt::format("times of poses cannot be: {} are missing, {} repeated, {} step back; the first is of pose {}",
                  found.times_missing, found.times_repeated, found.times_backwards, found.first_bad_time));
  say(found.missing > 0, fmt::format("{} poses have no picture in the video", found.missing));
  say(found.lost > 0, fmt::format("{} pictures have no pose in the log; they were tracked all the same", found.lost));
  say(found.other_runs > 0, fmt::format("{} poses are of other runs of a tracker, and other videos", found.other_runs));
  return lines;
}

}  // namespace eyeslam::replay
