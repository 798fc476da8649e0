// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/sensor.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/vector_kernel.h"

namespace eyeslam::simulation {

namespace {

constexpr std::size_t kTable = 1U << 17;
constexpr float kWhite = 255.0F;

// Of BGRx to BGR: in steps, so that the compiler's vectors take several values at once.
EYESLAM_VECTOR_KERNEL void levelsOf(const float* in, const float* passed, float on, int pixels, float black,
                                    float* __restrict level)
{
  for (int i = 0; i < pixels; ++i) {
    const float share = on * passed[i];
    for (int c = 0; c < 3; ++c) level[3 * i + c] = std::clamp(black + kWhite * (in[4 * i + c] * share), 0.0F, kWhite);
  }
}

EYESLAM_VECTOR_KERNEL void addNoise(const float* level, const float* noise, const float* deviation, int values,
                                    std::uint8_t* __restrict out)
{
  for (int i = 0; i < values; ++i) {
    const float noisy = level[i] + deviation[static_cast<int>(level[i])] * noise[i];
    out[i] = static_cast<std::uint8_t>(static_cast<int>(std::clamp(noisy + 0.5F, 0.0F, kWhite)));
  }
}

}  // namespace

Sensor::Sensor(const SensorOptions& options, std::uint64_t seed) : options_(options), random_(seed, 14)
{
  for (std::size_t i = 0; i < kTable; ++i) table_.push_back(static_cast<float>(random_.normal()));
  for (int level = 0; level < 256; ++level) {
    deviation_.push_back(static_cast<float>(std::hypot(options.read_noise, options.shot_noise * std::sqrt(level))));
  }
}

void Sensor::read(const cv::Mat& light, const cv::Mat_<float>& passed, float on, cv::Mat_<cv::Vec3b>& picture)
{
  CV_Assert(light.type() == CV_32FC4 && passed.size() == light.size());
  picture.create(light.size());
  const int values = 3 * light.cols;
  levels_.resize(static_cast<std::size_t>(values));
  repeatTable(kTable + levels_.size());
  for (int y = 0; y < light.rows; ++y) {
    levelsOf(light.ptr<float>(y), passed[y], on, light.cols, static_cast<float>(options_.black), levels_.data());
    const std::size_t place = static_cast<std::size_t>(random_.bits()) % kTable;
    addNoise(levels_.data(), table_.data() + place, deviation_.data(), values, picture.ptr<std::uint8_t>(y));
  }
}

// Its beginning again behind its end: a row of the picture never wraps.
void Sensor::repeatTable(std::size_t length)
{
  while (table_.size() < length) table_.push_back(table_[table_.size() - kTable]);
}

}  // namespace eyeslam::simulation
