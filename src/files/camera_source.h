// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/videoio.hpp>

#include "eyeslam/files/video_source.h"

namespace eyeslam::files {

/// A camera by its number (/dev/videoN); it ends when unplugged.
class CameraSource : public VideoSource {
 public:
  /// @throws FileError when there is no such camera
  CameraSource(int number, const VideoSourceOptions& options);

  bool read(VideoFrame& frame) override;
  void skipTo(std::int64_t first) override;
  std::optional<std::int64_t> announcedFrames() const override { return std::nullopt; }
  double framesPerSecond() const override;
  bool isLive() const override { return true; }

 private:
  VideoSourceOptions options_;
  cv::VideoCapture capture_;
  std::int64_t grabbed_ = 0;
  double start_ = 0.0;
};

}  // namespace eyeslam::files
