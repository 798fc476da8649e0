// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/cubic_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace eyeslam::tracking {
namespace {

constexpr int kSide = 16;
// The weights are rounded to 1/16384, four of them twice; so is the plane, to whole units.
constexpr double kRounding = 1.0;

cv::Mat_<std::int16_t> plane(const std::function<double(int, int)>& value)
{
  cv::Mat_<std::int16_t> result(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) result(y, x) = static_cast<std::int16_t>(std::lround(value(x, y)));
  }
  return result;
}

// Calls with random positions, multiples of 1/256 px, away from the border.
void atRandomPlaces(const std::function<void(float, float)>& check)
{
  std::mt19937 random(1);
  std::uniform_int_distribution<int> step(2 * 256, (kSide - 3) * 256 - 1);
  for (int i = 0; i < 2000; ++i)
    check(static_cast<float>(step(random)) / 256.0F, static_cast<float>(step(random)) / 256.0F);
}

TEST(CubicSampler, GivesWholePixelsExactly)
{
  std::mt19937 random(2);
  std::uniform_int_distribution<int> value(-8000, 8000);
  const cv::Mat_<std::int16_t> pixels = plane([&](int, int) { return value(random); });
  const CubicSampler sample(pixels);
  for (int y = 2; y < kSide - 2; ++y) {
    for (int x = 2; x < kSide - 2; ++x)
      ASSERT_FLOAT_EQ(sample(static_cast<float>(x), static_cast<float>(y)), pixels(y, x));
  }
}

TEST(CubicSampler, ReproducesLinearRamps)
{
  const cv::Mat_<std::int16_t> ramp = plane([](int x, int y) { return 100.0 * x - 60.0 * y + 10.0; });
  const CubicSampler sample(ramp);
  atRandomPlaces([&](float x, float y) { ASSERT_NEAR(sample(x, y), 100.0F * x - 60.0F * y + 10.0F, kRounding); });
}

TEST(CubicSampler, ReproducesQuadratics)
{
  const auto value = [](double x, double y) { return 20.0 * x * x - 14.0 * x * y + 8.0 * y * y; };
  const cv::Mat_<std::int16_t> quadratic = plane(value);
  const CubicSampler sample(quadratic);
  atRandomPlaces([&](float x, float y) {
    ASSERT_NEAR(sample(x, y), value(static_cast<double>(x), static_cast<double>(y)), kRounding);
  });
}

TEST(CubicSampler, DeviatesFromCubicsByWhatCatmullAndRomLeave)
{
  // The slope at a pixel of x^3 is taken too large by 1, which adds t (1 - t) (1 - 2 t) between pixels.
  const cv::Mat_<std::int16_t> cubic = plane([](int x, int) { return 4.0 * std::pow(x - 8, 3); });
  const CubicSampler sample(cubic);
  atRandomPlaces([&](float x, float y) {
    const double t = static_cast<double>(x) - std::floor(static_cast<double>(x));
    const double value = 4.0 * (std::pow(static_cast<double>(x) - 8.0, 3) + t * (1.0 - t) * (1.0 - 2.0 * t));
    ASSERT_NEAR(sample(x, y), value, kRounding);
  });
}

TEST(CubicSampler, AgreesWithDoublesOnAnyPlane)
{
  std::mt19937 random(3);
  std::uniform_int_distribution<int> value(-8000, 8000);
  const cv::Mat_<std::int16_t> pixels = plane([&](int, int) { return value(random); });
  const CubicSampler sample(pixels);
  const auto spline = [](double a, double b, double c, double d, double t) {
    return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
  };
  atRandomPlaces([&](float x, float y) {
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    double rows[4];
    for (int k = 0; k < 4; ++k) {
      const std::int16_t* row = pixels[j + k - 1] + i - 1;
      rows[k] = spline(row[0], row[1], row[2], row[3], static_cast<double>(x) - i);
    }
    const double expected = spline(rows[0], rows[1], rows[2], rows[3], static_cast<double>(y) - j);
    ASSERT_NEAR(sample(x, y), expected, 2.0);  // four weights off by 1/32768 of 8000, both ways
  });
}

TEST(CubicSampler, TakesTheNearestOf256StepsAPixel)
{
  const cv::Mat_<std::int16_t> ramp = plane([](int x, int) { return 256.0 * x; });
  const CubicSampler sample(ramp);
  for (int step = 0; step < 256; ++step) {
    const float x = 5.0F + (static_cast<float>(step) + 0.3F) / 256.0F;
    ASSERT_NEAR(sample(x, 6.0F), 1280.0F + static_cast<float>(step), 0.2F);
  }
}

}  // namespace
}  // namespace eyeslam::tracking
