// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/configuration/assignment.h"
#include "eyeslam/mark_t.hpp"
#include "eyeslam/replay/comparison.h"
#include "eyeslam/replay/recomputed_part.h"
#include "eyeslam/replay/side_video.h"
#include "eyeslam/replay/tracker_replay.h"
#include "eyeslam/replay/video_offset.h"

namespace eyeslam::replay {

struct VideoReplayOptions {
  std::string video;
  std::optional<double> offset_s;  ///< of the video's clock, to be believed instead of its being that of the poses
  /// Keys over the recorded configuration: "vision.tracker.matcher.min_points=..." of a trial, "matcher...." of
  /// eyeslam-track.
  std::vector<configuration::Assignment> changes;
};

/// Computes the tracker of a log again from the video beside it, as its MARKs say that it was configured: that of a
/// trial in lock step, which must say the same bytes, or that of `eyeslam-track`, whose localization must be the same.
/// Measures how far video and log are apart meanwhile. Memory does not grow with the log.
class VideoReplay final : public RecomputedPart {
 public:
  /// @param comparison  must outlive it
  /// @param each  hears the log with what was recomputed in the place of what was recorded; may be empty
  /// @throws files::FileError  the video
  VideoReplay(VideoReplayOptions options, Comparison& comparison, TrackerReplay::Each each = {});

  void take(const SortedEvent& event) override;
  void finish() override;
  std::string about() const override { return about_; }
  std::string lacking() const override;

  /// How far the clocks are apart (beyond the offset that was given); after the end. None where nothing tells.
  const std::optional<OffsetEstimate>& offset() const { return offset_; }
  /// That offset and the one that was given together, s: what to give instead.
  std::optional<double> advisedOffset() const;
  /// Frames by which the pictures were taken to be later than the poses of their numbers, as the offset has it.
  std::int64_t shift() const { return shift_; }
  /// All zero where there was nothing to track again.
  TrackerFindings findings() const { return replay_ ? replay_->findings() : TrackerFindings{}; }
  const SideVideo& video() const { return video_; }
  /// What somebody should look at, one line each; after the end.
  std::vector<std::string> warnings() const;

 private:
  void takeMark(const SortedEvent& event);
  void begin(const tracking::TrackerOptions& tracker, double frame_rate, TrackerOrder order, const mark_t& mark);

  VideoReplayOptions options_;
  Comparison& comparison_;
  TrackerReplay::Each each_;
  SideVideo video_;
  std::int64_t shift_;
  VideoOffset measured_;
  std::optional<TrackerReplay> replay_;
  std::optional<OffsetEstimate> offset_;
  std::string about_;
};

}  // namespace eyeslam::replay
