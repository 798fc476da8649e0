// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/image_motion.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace eyeslam::replay {
namespace {

constexpr double kWidth = 200.0;     // px of the small picture: vessels are still seen, a transform takes 0.3 ms
constexpr int kAround = 15;          // px of it, over which light changes and vessels do not
constexpr double kLeastPeak = 0.03;  // of the correlation; two unlike pictures have half of it

}  // namespace

cv::Mat ImageMotion::reduced(const cv::Mat& image)
{
  const double scale = std::min(1.0, kWidth / image.cols);
  const cv::Size size(cvRound(image.cols * scale), cvRound(image.rows * scale));
  if (image.channels() == 1)
    green_ = image;
  else
    cv::extractChannel(image, green_, 1);
  cv::Mat small, around, result;
  cv::resize(green_, small, size, 0.0, 0.0, cv::INTER_AREA);
  small.convertTo(result, CV_32F);
  cv::blur(result, around, {kAround, kAround});
  return result - around;
}

std::optional<cv::Point2d> ImageMotion::add(const cv::Mat& image)
{
  cv::Mat now = reduced(image);
  const cv::Mat before = std::exchange(before_, now);
  if (before.size() != now.size()) return std::nullopt;
  if (window_.size() != now.size()) cv::createHanningWindow(window_, now.size(), CV_32F);
  double peak = 0.0;
  const cv::Point2d moved = cv::phaseCorrelate(before, now, window_, &peak);
  if (!(peak > kLeastPeak) || !std::isfinite(moved.x) || !std::isfinite(moved.y)) return std::nullopt;
  return moved * (static_cast<double>(image.cols) / now.cols);
}

}  // namespace eyeslam::replay
