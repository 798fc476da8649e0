// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/pixel_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace eyeslam::files {
namespace {

double fullScale(const cv::Mat& image) { return image.depth() == CV_16U ? 65535.0 : 255.0; }

}  // namespace

bool isLit(const cv::Mat& image)
{
  constexpr double kDark = 8.0 / 255.0;  // a black frame of a noisy camera stays below
  const cv::Scalar mean = cv::mean(image);
  return std::max({mean[0], mean[1], mean[2]}) > kDark * fullScale(image);
}

bool hasEqualChannels(const cv::Mat& image)
{
  constexpr double kRounding = 4.0 / 255.0;  // BGR to YUV of limited range and back: up to 3 were seen
  if (image.channels() != 3) return false;
  cv::Mat blue, green, red;
  cv::extractChannel(image, blue, 0);
  cv::extractChannel(image, green, 1);
  cv::extractChannel(image, red, 2);
  const double most = kRounding * fullScale(image);
  return cv::norm(blue, green, cv::NORM_INF) <= most && cv::norm(red, green, cv::NORM_INF) <= most;
}

std::string makeUsable(cv::Mat& image)
{
  if (image.depth() != CV_8U && image.depth() != CV_16U) {
    image.release();
    return "";
  }
  if (image.channels() == 4) {
    cv::cvtColor(image, image, cv::COLOR_BGRA2BGR);
    return "alpha left out";
  }
  if (image.channels() == 2) {
    cv::extractChannel(image, image, 0);
    return "second channel left out";
  }
  return "";
}

std::string describe(const cv::Mat& image)
{
  const char* const kDepths[] = {"8 bit",  "8 bit signed", "16 bit",       "16 bit signed",
                                 "32 bit", "32 bit float", "64 bit float", "16 bit float"};
  return fmt::format("{} x {}, {} channel{} of {}", image.cols, image.rows, image.channels(),
                     image.channels() == 1 ? "" : "s", kDepths[image.depth()]);
}

}  // namespace eyeslam::files
