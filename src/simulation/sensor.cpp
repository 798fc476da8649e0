// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/sensor.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::simulation {

namespace {

constexpr std::size_t kTable = 1U << 17;

}  // namespace

Sensor::Sensor(const SensorOptions& options, std::uint64_t seed) : options_(options), random_(seed, 14)
{
  for (std::size_t i = 0; i < kTable; ++i) table_.push_back(static_cast<float>(random_.normal()));
  for (int level = 0; level < 256; ++level) {
    deviation_.push_back(static_cast<float>(std::hypot(options.read_noise, options.shot_noise * std::sqrt(level))));
  }
}

void Sensor::read(const cv::Mat& light, cv::Mat_<cv::Vec3b>& picture)
{
  CV_Assert(light.type() == CV_32FC4);
  picture.create(light.size());
  const std::size_t row_length = 3 * static_cast<std::size_t>(light.cols);
  const auto black = static_cast<float>(options_.black);
  for (int y = 0; y < light.rows; ++y) {
    const float* in = light.ptr<float>(y);
    std::uint8_t* out = picture.ptr<std::uint8_t>(y);
    std::size_t place = static_cast<std::size_t>(random_.bits()) % kTable;
    for (std::size_t i = 0; i < row_length; i += 3, in += 4) {
      for (std::size_t c = 0; c < 3; ++c) {
        const float level = std::clamp(black + 255.0F * in[c], 0.0F, 255.0F);
        const float noisy = level + deviation_[static_cast<std::size_t>(level)] * table_[(place + c) & (kTable - 1)];
        out[i + c] = static_cast<std::uint8_t>(std::clamp(noisy + 0.5F, 0.0F, 255.0F));
      }
      place += 3;
    }
  }
}

}  // namespace eyeslam::simulation
