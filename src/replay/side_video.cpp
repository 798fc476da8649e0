// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/side_video.h"

#include "eyeslam/files/file_error.h"

namespace eyeslam::replay {

SideVideo::SideVideo(const std::string& path, std::int64_t shift)
    : source_(files::openVideoSource(path, {})), shift_(shift)
{}

// Damage ends the video, and what was read until then stands.
bool SideVideo::read()
{
  if (ended_) return false;
  try {
    ended_ = !source_->read(frame_);
  } catch (const files::FileError& error) {
    failure_ = error.what();
    ended_ = true;
  }
  if (ended_) return false;
  if (each_) each_(next_, frame_.image);
  ++next_;
  return true;
}

const cv::Mat& SideVideo::pictureOf(std::int64_t pose)
{
  const std::int64_t wanted = pose - shift_;
  while (next_ <= wanted && read()) continue;
  return wanted >= 0 && next_ == wanted + 1 ? frame_.image : none_;
}

}  // namespace eyeslam::replay
