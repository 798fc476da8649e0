// SPDX-License-Identifier: GPL-3.0-or-later
// Draws a few vessels, moves them by a known shift, and expects the tracker to find it.
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "eyeslam/tracking/eyeslam_tracker.h"

namespace {

cv::Mat retina(int shift_x, int shift_y)
{
  cv::Mat image(480, 640, CV_8UC3, cv::Scalar(30, 70, 170));
  cv::RNG random(7);
  for (int i = 0; i < 14; ++i) {
    const cv::Point from(random.uniform(-100, 740) + shift_x, random.uniform(-100, 580) + shift_y);
    const cv::Point to(random.uniform(-100, 740) + shift_x, random.uniform(-100, 580) + shift_y);
    cv::line(image, from, to, cv::Scalar(20, 40, 120), random.uniform(4, 10), cv::LINE_AA);
  }
  cv::GaussianBlur(image, image, {5, 5}, 0.0);
  return image;
}

}  // namespace

int main()
{
  eyeslam::tracking::EyeSlamTracker tracker;
  tracker.initTracking(retina(0, 0));
  for (int i = 1; i <= 5; ++i) tracker.track(retina(-2 * i, i));

  // The picture moved by (-10, 5), so the view moved by (10, -5) on the map.
  const eyeslam::tracking::TrackResult& result = tracker.getResult();
  std::printf("tracked %d at (%.2f, %.2f), expected (10, -5)\n", result.tracked, result.map_T_frame.x,
              result.map_T_frame.y);
  const double error = std::hypot(result.map_T_frame.x - 10.0, result.map_T_frame.y + 5.0);
  return result.tracked && error < 0.5 ? 0 : 1;
}
