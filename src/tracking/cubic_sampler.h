// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

namespace eyeslam::tracking {

/// Catmull-Rom interpolation of a 16-bit plane at 1/256 px, with integer weights and no rounding to 1/32 px as in
/// OpenCV's warps: whole pixels cost the refinement a factor of six, bilinear a few per cent (tracker study, 4).
class CubicSampler {
 public:
  /// Samples need one pixel before and two after the position.
  static constexpr float kMargin = 2.0F;

  explicit CubicSampler(const cv::Mat_<std::int16_t>& plane)
      : first_(plane[0]), stride_(static_cast<std::ptrdiff_t>(plane.step1()))
  {}

  /// Value at (x, y), which must lie at least kMargin inside the plane. Plane values must stay within +-16000.
  float operator()(float x, float y) const
  {
    const int at_x = static_cast<int>(x * kSteps + 0.5F);
    const int at_y = static_cast<int>(y * kSteps + 0.5F);
    const std::int16_t* corner = first_ + ((at_y / kSteps) - 1) * stride_ + (at_x / kSteps) - 1;
    const cv::v_int16x8 along = cv::v_load(kWeights.twice[at_x % kSteps].data());
    const cv::v_int16x8 upper = cv::v_load_halves(corner, corner + stride_);
    const cv::v_int16x8 lower = cv::v_load_halves(corner + 2 * stride_, corner + 3 * stride_);
    // Two partial sums for each of the four rows, then the weights down the column.
    const cv::v_float32x4 sums_upper = cv::v_cvt_f32(cv::v_dotprod(upper, along));
    const cv::v_float32x4 sums_lower = cv::v_cvt_f32(cv::v_dotprod(lower, along));
    const float* down = kWeights.down[at_y % kSteps].data();
    return cv::v_reduce_sum(sums_upper * cv::v_load(down) + sums_lower * cv::v_load(down + 4));
  }

 private:
  static constexpr int kSteps = 256;  // positions per px
  static constexpr int kUnit = 1 << 14;

  struct Weights {
    std::array<std::array<std::int16_t, 8>, kSteps> twice{};  // the four weights, twice, times kUnit
    std::array<std::array<float, 8>, kSteps> down{};          // each of the four weights twice, over kUnit

    constexpr Weights()
    {
      for (int i = 0; i < kSteps; ++i) {
        const double t = static_cast<double>(i) / kSteps;
        const double w[4] = {0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (3.0 * t - 5.0),
                             0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
        for (std::size_t k = 0; k < 4; ++k) {
          const double scaled = w[k] * kUnit;
          twice[static_cast<std::size_t>(i)][k] = static_cast<std::int16_t>(scaled < 0.0 ? scaled - 0.5 : scaled + 0.5);
          twice[static_cast<std::size_t>(i)][k + 4] = twice[static_cast<std::size_t>(i)][k];
          down[static_cast<std::size_t>(i)][2 * k] = static_cast<float>(w[k] / kUnit);
          down[static_cast<std::size_t>(i)][2 * k + 1] = static_cast<float>(w[k] / kUnit);
        }
      }
    }
  };
  static const Weights kWeights;

  const std::int16_t* first_;
  std::ptrdiff_t stride_;
};

inline constexpr CubicSampler::Weights CubicSampler::kWeights{};

}  // namespace eyeslam::tracking
