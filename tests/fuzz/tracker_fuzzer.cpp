// SPDX-License-Identifier: GPL-3.0-or-later
// A few frames of any size, type and content through the tracker: a verdict for each, finite numbers, no exception.
#include <fuzzer/FuzzedDataProvider.h>

#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "eyeslam/tracking/eyeslam_tracker.h"

using namespace eyeslam;

namespace {

constexpr int kTypes[] = {CV_8UC3, CV_8UC1, CV_16UC1, CV_16UC3, CV_8UC4, CV_32FC1};

// Vessels, noise, darkness, light, stripes.
void paint(cv::Mat& image, FuzzedDataProvider& chance)
{
  const bool deep = image.depth() != CV_8U;
  const double white = deep ? 65535.0 : 255.0;
  cv::RNG random(chance.ConsumeIntegral<std::uint32_t>());
  image.setTo(cv::Scalar::all(white * chance.ConsumeProbability<double>()));
  const int lines = chance.ConsumeIntegralInRange(0, 20);
  for (int i = 0; i < lines; ++i) {
    const cv::Point from(random.uniform(-50, image.cols + 50), random.uniform(-50, image.rows + 50));
    const cv::Point to(random.uniform(-50, image.cols + 50), random.uniform(-50, image.rows + 50));
    cv::line(image, from, to, cv::Scalar::all(white * random.uniform(0.0, 1.0)), random.uniform(1, 12));
  }
  if (chance.ConsumeBool()) random.fill(image, cv::RNG::UNIFORM, 0, white);
}

void checkFinite(const tracking::TrackResult& result)
{
  const auto& pose = result.map_T_frame;
  const bool finite = std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta) &&
                      std::isfinite(pose.scale) && result.covariance.allFinite() && std::isfinite(result.score);
  if (!finite || (!result.tracked && result.reason == retina::Reason::none)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  FuzzedDataProvider chance(bytes, size);
  tracking::EyeSlamTracker tracker;
  cv::Size shape(chance.ConsumeIntegralInRange(1, 260), chance.ConsumeIntegralInRange(1, 200));
  int type = chance.PickValueInArray(kTypes);
  const int frames = chance.ConsumeIntegralInRange(1, 6);
  for (int i = 0; i < frames; ++i) {
    if (chance.ConsumeIntegralInRange(0, 9) == 0) shape.width = chance.ConsumeIntegralInRange(0, 260);
    if (chance.ConsumeIntegralInRange(0, 9) == 0) type = chance.PickValueInArray(kTypes);
    cv::Mat image(shape, type);
    if (!image.empty()) paint(image, chance);
    checkFinite(tracker.track(image));
    tracker.updateMap();
  }
  tracker.finishMap();
  return 0;
}
