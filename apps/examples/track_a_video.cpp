// SPDX-License-Identifier: GPL-3.0-or-later
// track_a_video VIDEO: prints where the view is in each frame, and writes the retina seen and its vessels as pictures.
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "eyeslam/tracking/eyeslam_tracker.h"

int main(int argc, char** argv)
{
  cv::VideoCapture video(argc > 1 ? argv[1] : "");
  eyeslam::tracking::EyeSlamTracker tracker;
  cv::Mat image;
  while (video.read(image)) {
    const auto& result = tracker.track(image);
    tracker.updateMap();
    if (result.tracked) {
      const auto& pose = result.map_T_frame;
      std::cout << result.frame << ": x " << pose.x << " px, y " << pose.y << " px, " << pose.theta << " rad\n";
    } else {
      std::cout << result.frame << ": not tracked, " << eyeslam::retina::word(result.reason) << '\n';
    }
  }
  tracker.finishMap();
  cv::Point2d origin;
  double px_per_pixel = 1.0;
  cv::imwrite("mosaic.png", tracker.getMosaic(origin, px_per_pixel));
  auto map = tracker.getVesselMap();
  cv::imwrite("vessels.png", cv::Mat(map.height, map.width, CV_8U, map.probability.data()));
}
