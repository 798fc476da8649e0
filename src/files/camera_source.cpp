// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/camera_source.h"

#include <fmt/format.h>

namespace eyeslam::files {

CameraSource::CameraSource(int number, const VideoSourceOptions& options)
    : options_(options), capture_(number, cv::CAP_V4L2)
{
  if (!capture_.isOpened()) {
    throw FileError(
        fmt::format("camera:{}: there is no such camera, or it is in use; ls /dev/video* lists them", number));
  }
}

bool CameraSource::read(VideoFrame& frame)
{
  if (options_.last_frame >= 0 && grabbed_ > options_.last_frame) return false;
  if (!capture_.read(frame.image) || frame.image.empty()) return false;
  const double now = options_.now();
  if (grabbed_ == 0) start_ = now;
  frame.number = grabbed_++;
  frame.t = now - start_;
  return true;
}

void CameraSource::skipTo(std::int64_t first)
{
  VideoFrame skipped;
  while (grabbed_ < first && read(skipped)) continue;
}

double CameraSource::framesPerSecond() const
{
  const double rate = capture_.get(cv::CAP_PROP_FPS);
  return rate > 0.0 ? rate : options_.frames_per_second;
}

}  // namespace eyeslam::files
