// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>

namespace eyeslam::tracking {

/// Blue and red at a place, 0 to 255. Where there is no colour, blue is the brightness and red the level of the light:
/// whatever compares the two then compares brightness with a threshold.
struct Tint {
  float blue = 0.0F;
  float red = 0.0F;

  /// Above 0 where blue exceeds that share of the red: steel rather than retina.
  float excess(float share) const { return blue - share * red; }
};

/// Reads an image, 8 or 16 bit, one channel or BGR, between its pixels (bilinear; beyond its border: the border).
class TintSampler {
 public:
  /// @param white        brightest value of the image; @param light  level of the light for grey images, 0 to 255
  TintSampler(const cv::Mat& image, double white, double light)
      : image_(image), gain_(static_cast<float>(255.0 / white)), light_(static_cast<float>(light))
  {}

  bool hasColour() const { return image_.channels() == 3; }

  bool contains(const Eigen::Vector2d& at) const
  {
    return at.x() >= 0.0 && at.y() >= 0.0 && at.x() <= image_.cols - 1 && at.y() <= image_.rows - 1;
  }

  Tint operator()(const Eigen::Vector2d& at) const
  {
    return image_.depth() == CV_8U ? read<std::uint8_t>(at) : read<std::uint16_t>(at);
  }

 private:
  template <class T>
  Tint read(const Eigen::Vector2d& at) const
  {
    const auto x = static_cast<float>(std::clamp(at.x(), 0.0, image_.cols - 1.001));
    const auto y = static_cast<float>(std::clamp(at.y(), 0.0, image_.rows - 1.001));
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const float u = x - static_cast<float>(column), v = y - static_cast<float>(row);
    const int channels = image_.channels();
    const T* upper = image_.ptr<T>(row) + column * channels;
    const T* lower = image_.ptr<T>(std::min(row + 1, image_.rows - 1)) + column * channels;
    const auto mix = [&](int channel) {
      const auto a = static_cast<float>(upper[channel]), b = static_cast<float>(upper[channel + channels]);
      const auto c = static_cast<float>(lower[channel]), d = static_cast<float>(lower[channel + channels]);
      return gain_ * ((a + u * (b - a)) * (1.0F - v) + (c + u * (d - c)) * v);
    };
    return channels == 3 ? Tint{mix(0), mix(2)} : Tint{mix(0), light_};
  }

  const cv::Mat& image_;
  float gain_;
  float light_;
};

}  // namespace eyeslam::tracking
