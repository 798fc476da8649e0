// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/vision/frozen_picture.h"

#include <cstring>

namespace eyeslam::vision {
namespace {

bool areEqual(const cv::Mat& a, const cv::Mat& b)
{
  if (a.empty() || a.size() != b.size() || a.type() != b.type()) return false;
  const std::size_t bytes = static_cast<std::size_t>(a.cols) * a.elemSize();
  for (int y = 0; y < a.rows; ++y) {
    if (std::memcmp(a.ptr(y), b.ptr(y), bytes) != 0) return false;
  }
  return true;
}

}  // namespace

bool FrozenPicture::repeats(const cv::Mat& image)
{
  if (areEqual(image, last_)) return true;
  image.copyTo(last_);
  return false;
}

const tracking::TrackResult& FrozenPicture::freeze()
{
  result_.tracked = false;
  result_.reason = retina::Reason::frozen;
  result_.velocity.setZero();
  result_.points = 0;
  result_.score = 0.0;
  return result_;
}

}  // namespace eyeslam::vision
