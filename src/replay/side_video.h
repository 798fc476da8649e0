// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

#include "eyeslam/files/video_source.h"

namespace eyeslam::replay {

/// The video beside a log: picture n is that of the tracker's n-th pose, for both hold each frame that was tracked.
/// `shift` says otherwise: its first picture is that of pose `shift` (negative: it begins before the first pose).
class SideVideo {
 public:
  /// Hears each picture that is read, once, with its number in the video.
  using Each = std::function<void(std::int64_t number, const cv::Mat& image)>;

  /// Poses that may be missing in a row; the number of one farther on is no gap, but cannot be.
  static constexpr std::int64_t kMostLost = 10'000;

  /// @throws files::FileError naming the file
  explicit SideVideo(const std::string& path, std::int64_t shift = 0);

  /// Before the first picture of a pose.
  void setShift(std::int64_t shift) { shift_ = shift; }
  void onPicture(Each each) { each_ = std::move(each); }
  /// The picture of a pose by its number; poses are asked for in rising order. Those between are read, and heard.
  /// @return empty where the video has none; valid until the next call
  const cv::Mat& pictureOf(std::int64_t pose);
  /// Reads one more picture, for who looks at nothing else. @return false at the end
  bool read();

  double framesPerSecond() const { return source_->framesPerSecond(); }
  /// As far as the container knows; -1: it does not.
  std::int64_t announced() const { return source_->announcedFrames().value_or(-1); }
  /// Pictures read so far.
  std::int64_t pictures() const { return next_; }
  bool ended() const { return ended_; }
  /// Pictures whose time in the container was no later than that of the one before.
  std::int64_t timesRepaired() const { return source_->timesRepaired(); }
  /// What looks doubtful about the file, or why it ended early; one line each.
  const std::vector<std::string>& notices() const { return source_->notices(); }
  /// Why no more could be decoded; empty at an ordinary end.
  const std::string& failure() const { return failure_; }

 private:
  std::unique_ptr<files::VideoSource> source_;
  std::int64_t shift_;
  Each each_;
  files::VideoFrame frame_;
  const cv::Mat none_;
  std::int64_t next_ = 0;
  bool ended_ = false;
  std::string failure_;
};

}  // namespace eyeslam::replay
