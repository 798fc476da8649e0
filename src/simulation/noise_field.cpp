// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/noise_field.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace eyeslam::simulation {

cv::Mat_<float> smoothNoise(cv::Size size, double cell_px, Random& random)
{
  const double cell = std::max(1.0, cell_px);
  cv::Mat_<float> grid(static_cast<int>(size.height / cell) + 3, static_cast<int>(size.width / cell) + 3);
  for (float& value : grid) value = static_cast<float>(random.normal());
  cv::Mat_<float> wide;
  cv::resize(grid, wide, {static_cast<int>(grid.cols * cell) + 1, static_cast<int>(grid.rows * cell) + 1}, 0, 0,
             cv::INTER_CUBIC);
  // Interpolation averages: between grid points the deviation is smaller.
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(wide, mean, deviation);
  const cv::Mat_<float> part = wide(cv::Rect({0, 0}, size));
  cv::Mat_<float> result;
  part.convertTo(result, CV_32F, 1.0 / deviation[0], -mean[0] / deviation[0]);
  return result;
}

cv::Mat_<float> fractalNoise(cv::Size size, double coarsest_px, int octaves, double falloff, Random& random)
{
  cv::Mat_<float> sum(size, 0.0F);
  double cell = coarsest_px;
  double amplitude = 1.0;
  double power = 0.0;
  for (int i = 0; i < octaves && cell >= 1.0; ++i) {
    cv::scaleAdd(smoothNoise(size, cell, random), amplitude, sum, sum);
    power += amplitude * amplitude;
    cell /= 2.0;
    amplitude *= falloff;
  }
  if (power > 0.0) sum *= 1.0 / std::sqrt(power);
  return sum;
}

}  // namespace eyeslam::simulation
