// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/videoio.hpp>
#include <string>

namespace eyeslam::files {

/// How a video is stored. Lossless keeps every bit of 8-bit frames, in Matroska.
enum class VideoCoding { h264, lossless };

/// Writes a video whose success is checked: OpenCV's writer drops frames and full disks without a word.
class VideoFile {
 public:
  /// @param path   where to write; `shown` names the file in messages
  VideoFile(std::string path, std::string shown, VideoCoding coding, double frames_per_second);

  /// Adds a frame, 8 bit, grey or BGR; all of one size an odd last row or column is left out, or
  /// refused where nothing may be lost.
  /// @throws FileError when the encoder cannot be started, the frame is not like the first, or a lossless file has
  ///                   stopped growing (disk full), which shows within 0.3 MB of frames
  void add(const cv::Mat& image);

  /// Ends the file and counts what arrived. Without a frame there is no file.
  /// @throws FileError when not all frames can be found in it
  void close();

 private:
  void open(const cv::Mat& image);
  void checkGrowth();

  std::string path_;
  std::string shown_;
  VideoCoding coding_;
  double rate_;
  cv::VideoWriter writer_;
  cv::Size size_;
  cv::Mat colour_;
  std::int64_t count_ = 0;
  std::uintmax_t bytes_ = 0;        // of the file when it last grew
  std::int64_t frames_unseen_ = 0;  // since then
};

}  // namespace eyeslam::files
