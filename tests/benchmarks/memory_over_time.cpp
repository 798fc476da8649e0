// SPDX-License-Identifier: GPL-3.0-or-later
// memory_over_time VIDEO [FRAMES]: tracks a video over and over for 10,000 frames, with its published map, and prints
// the resident memory on the way. Every start from the beginning is a jump of the eye.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "eyeslam/tracking/eyeslam_tracker.h"

namespace {

constexpr int kFrames = 10000;
constexpr int kReport = 1000;  // frames
constexpr double kPage_MB = 4096.0 / 1e6;

double residentMegabytes()
{
  std::int64_t size = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> size >> resident;
  return static_cast<double>(resident) * kPage_MB;
}

bool readLooped(cv::VideoCapture& video, cv::Mat& image)
{
  if (video.read(image)) return true;
  video.set(cv::CAP_PROP_POS_FRAMES, 0);
  return video.read(image);
}

}  // namespace

int main(int argc, char** argv)
{
  cv::setNumThreads(1);
  cv::VideoCapture video;
  if (argc < 2 || !video.open(argv[1])) {
    std::fprintf(stderr, "memory_over_time VIDEO [FRAMES]: a video that can be read is wanted\n");
    return 2;
  }
  const int frames = argc > 2 ? std::atoi(argv[2]) : kFrames;
  eyeslam::tracking::EyeSlamTracker tracker;
  cv::Mat image;
  int tracked = 0;
  for (int frame = 1; frame <= frames && readLooped(video, image); ++frame) {
    tracked += tracker.track(image).tracked;
    tracker.updateMap();
    if (frame % kReport == 0) std::printf("%d frames, %d tracked: %.1f MB\n", frame, tracked, residentMegabytes());
    std::fflush(stdout);
  }
  return 0;
}
