// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

namespace eyeslam::files {

/// H.264 of a chosen quality, through the program `ffmpeg`: OpenCV's writer has one quality only (crf 23), which wipes
/// out the finest vessels, and ignores OPENCV_FFMPEG_WRITER_OPTIONS.
class EncodedVideo {
 public:
  /// @param path   where to write; `shown` names the file in messages
  /// @param size   of all frames, even
  /// @param crf    quality, 0 (best) to 51
  /// @throws FileError when the encoder does not start
  EncodedVideo(const std::string& path, std::string shown, cv::Size size, double frames_per_second, int crf);
  ~EncodedVideo();
  EncodedVideo(EncodedVideo&& other) noexcept;
  EncodedVideo(const EncodedVideo&) = delete;
  EncodedVideo& operator=(const EncodedVideo&) = delete;

  /// Adds a frame, CV_8UC3, BGR. @throws FileError when the encoder has gone
  void add(const cv::Mat& image);
  /// Ends the file. @throws FileError when the encoder failed or frames are missing
  void close();

 private:
  [[noreturn]] void fail(const std::string& cause) const;
  int finish();

  std::string path_;
  std::string shown_;
  cv::Size size_;
  pid_t encoder_ = -1;
  int pipe_ = -1;
  std::int64_t count_ = 0;
};

}  // namespace eyeslam::files
