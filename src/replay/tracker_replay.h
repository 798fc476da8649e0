// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/messaging/event_tap.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/replay/comparison.h"
#include "eyeslam/replay/kept_message.h"
#include "eyeslam/replay/side_video.h"
#include "eyeslam/replay/sorted_log.h"
#include "eyeslam/vision/lock_step_tracker.h"

namespace eyeslam::replay {

/// In which order a tracker does its work, and what of its messages is decided by clocks.
enum class TrackerOrder {
  lock_step,  ///< a trial's: tracked when the exposure is over, sent later; every byte repeats
  live,       ///< eyeslam-track's: sent once it is tracked, before the map is worked on; times of sending differ
};

struct TrackerReplayOptions {
  tracking::TrackerOptions tracker;
  double frame_rate = 30.0;  ///< nominal, 1/s
  TrackerOrder order = TrackerOrder::lock_step;
};

/// What is worth saying besides the comparison.
struct TrackerFindings {
  std::int64_t frames = 0;         ///< tracked again
  std::int64_t missing = 0;        ///< poses of the log without a picture in the video
  std::int64_t lost = 0;           ///< pictures whose pose is not in the log: tracked, not compared
  std::int64_t other_runs = 0;     ///< poses of other sessions than the first: of another video
  std::int64_t times_missing = 0;  ///< poses whose utime is not positive
  std::int64_t times_repeated = 0;
  std::int64_t times_backwards = 0;
  std::int64_t first_bad_time = -1;  ///< number of the first pose with any of these
};

/// Tracks the pictures of a log's video again, with the stamps that the log has, through the very code of the trial or
/// of the live tracker, and holds RETINA_POSE, TOOL_TIP and VESSEL_MAP against the recorded ones.
///
///   TrackerReplay replay(options, video, comparison);
///   while (const auto event = log.next()) replay.take(*event);
///   replay.finish();
///
/// A frame counts as seen when its exposure is over, so a message is computed once the next frame is known: at most a
/// frame and the latency are held. Pictures whose stamps were lost from the log are tracked all the same.
class TrackerReplay {
 public:
  using Each = std::function<void(const SortedEvent&)>;

  /// @param video, comparison  must outlive it
  /// @param each  hears the log with the recomputed messages in the place of the recorded ones; may be empty
  TrackerReplay(const TrackerReplayOptions& options, SideVideo& video, Comparison& comparison, Each each = {});
  ~TrackerReplay();
  TrackerReplay(const TrackerReplay&) = delete;
  TrackerReplay& operator=(const TrackerReplay&) = delete;

  void take(const SortedEvent& event);
  /// After the last event.
  void finish();

  const TrackerFindings& findings() const { return findings_; }

 private:
  struct Engine;
  struct Computed {
    std::int64_t number = 0;
    std::vector<std::uint8_t> bytes;
  };
  struct Held {
    explicit Held(const SortedEvent& event) : sorted(event), message(event.event) {}
    SortedEvent sorted;  // but for its bytes, which are the message's
    KeptMessage message;
    bool vision = false;                // of the tracker that is replayed
    messaging::MessageHeader header{};  // of messages that the replay needs
    SortedEvent event() const;
  };
  struct Channel {
    bool begun = false;  // something was recorded on it
    std::deque<Computed> computed;
  };
  struct Look {
    std::int64_t number = 0;  // of the pose, from 0
    messaging::FrameStamp stamp;
    std::int64_t ready = 0;  // us since 1970; live: when it was sent
    std::int64_t over = 0;   // the exposure, us since 1970
    bool known = true;       // its stamp is the log's
  };

  void begin(std::int64_t session, std::int64_t part);
  void expectFrame(const Held& held);
  void expect(std::int64_t number, const messaging::FrameStamp& stamp, std::int64_t ready);
  void judgeTime(std::int64_t number, std::int64_t utime);
  void expectFramesAfterTheLast();
  bool mayProcess(const Held& held, std::int64_t newest) const;
  void process(const Held& held);
  void hearScale();
  bool hasHeardScale(const Held& held) const;
  void lookUntil(const Held& held);
  void look(const Look& due);
  void lookLive(const Look& due, const cv::Mat& image);
  void drain(std::int64_t utime);
  void hear(const messaging::TappedEvent& event);
  void compare(const Held& held);
  void align(const Held& recorded, std::vector<std::uint8_t>& bytes) const;

  TrackerReplayOptions options_;
  SideVideo& video_;
  Comparison& comparison_;
  Each each_;
  std::unique_ptr<Engine> engine_;  // from the first pose on
  std::deque<Held> held_;
  std::deque<Look> looks_;
  std::optional<Held> scale_;  // a registration that the tracker has not read yet
  std::map<std::string, Channel, std::less<>> channels_;
  std::int64_t session_ = 0, part_ = 0, next_number_ = 0;  // part_: of the log, where several were joined
  messaging::FrameStamp last_;                             // stamp of the newest known frame
  std::int64_t period_us_;                                 // of frames, as their stamps have it
  std::int64_t last_sent_ = 0;                             // us since 1970, the newest
  std::int64_t place_us_ = 0;                              // of the event being processed, since the log's first
  TrackerFindings findings_;
};

}  // namespace eyeslam::replay
