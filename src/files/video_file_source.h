// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/videoio.hpp>

#include "eyeslam/files/frame_times.h"
#include "eyeslam/files/video_source.h"

namespace eyeslam::files {

/// A video file, decoded by FFmpeg.
class VideoFileSource : public VideoSource {
 public:
  /// @throws FileError when FFmpeg finds no picture in it
  VideoFileSource(const std::string& path, const VideoSourceOptions& options);

  bool read(VideoFrame& frame) override;
  void skipTo(std::int64_t first) override;
  std::optional<std::int64_t> announcedFrames() const override;
  double framesPerSecond() const override { return rate_; }
  std::int64_t timesRepaired() const override { return times_.repaired(); }
  std::vector<std::string> paths() const override { return {path_}; }

 private:
  bool grab();
  void take(cv::Mat& image);
  void checkCompleteness();
  void checkSize(const cv::Mat& image);

  std::string path_;
  VideoSourceOptions options_;
  cv::VideoCapture capture_;
  double rate_ = 0.0;
  std::int64_t announced_ = 0;
  bool count_is_evidence_ = false;  // mp4 and its kin count frames, mkv and avi guess
  bool grey_ = false;
  FrameTimes times_;
  std::int64_t grabbed_ = 0;
  double time_ = 0.0;  // of the last grabbed frame
  cv::Size size_;
  cv::Mat colour_;
};

}  // namespace eyeslam::files
