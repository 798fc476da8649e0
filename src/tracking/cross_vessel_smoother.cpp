// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/cross_vessel_smoother.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace eyeslam::tracking {

namespace {

constexpr int kWidestHalf = 10;  // of the average, frame px
constexpr int kFarthest = 6 + kWidestHalf;
using CrossProfile = std::array<float, 2 * kFarthest + 1>;

// Bilinear, inside the picture.
inline float sample(const std::int16_t* pixels, std::ptrdiff_t row_step, float x, float y)
{
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const float fx = x - static_cast<float>(left);
  const float fy = y - static_cast<float>(top);
  const std::int16_t* upper = pixels + top * row_step + left;
  const std::int16_t* lower = upper + row_step;
  const float above = static_cast<float>(upper[0]) + fx * static_cast<float>(upper[1] - upper[0]);
  const float below = static_cast<float>(lower[0]) + fx * static_cast<float>(lower[1] - lower[0]);
  return above + fy * (below - above);
}

bool isInside(const cv::Mat& plane, const VesselPoint& point, float reach)
{
  return point.x >= reach && point.y >= reach && point.x < static_cast<float>(plane.cols) - 1.0F - reach &&
         point.y < static_cast<float>(plane.rows) - 1.0F - reach;
}

// Sums along the vessel, at whole offsets across it.
void measure(const cv::Mat_<std::int16_t>& plane, const VesselPoint& point, int farthest, int along,
             CrossProfile& profile)
{
  const float dx = std::cos(point.direction);
  const float dy = std::sin(point.direction);
  const auto row_step = static_cast<std::ptrdiff_t>(plane.step1());
  std::fill(profile.begin(), profile.end(), 0.0F);
  for (int a = -along; a <= along; a += std::max(along, 1)) {
    const float x = point.x + static_cast<float>(a) * dx;
    const float y = point.y + static_cast<float>(a) * dy;
    for (int j = -farthest; j <= farthest; ++j) {
      profile[static_cast<std::size_t>(j + kFarthest)] +=
          sample(plane[0], row_step, x - static_cast<float>(j) * dy, y + static_cast<float>(j) * dx);
    }
  }
}

// Where the running average over 2 half + 1 offsets is least, by a parabola; none when that is at the end of the reach.
std::optional<float> darkest(const CrossProfile& profile, int half, int reach)
{
  const auto average = [&](int at) {
    float sum = 0.0F;
    for (int j = at - half; j <= at + half; ++j) sum += profile[static_cast<std::size_t>(j + kFarthest)];
    return sum;
  };
  std::array<float, 15> averages{};
  int best = 0;
  for (int at = -reach; at <= reach; ++at) {
    averages[static_cast<std::size_t>(at + reach)] = average(at);
    if (averages[static_cast<std::size_t>(at + reach)] < averages[static_cast<std::size_t>(best + reach)]) best = at;
  }
  if (std::abs(best) == reach) return std::nullopt;
  const float before = averages[static_cast<std::size_t>(best + reach - 1)];
  const float after = averages[static_cast<std::size_t>(best + reach + 1)];
  const float bend = before + after - 2.0F * averages[static_cast<std::size_t>(best + reach)];
  return static_cast<float>(best) + (bend > 0.0F ? 0.5F * (before - after) / bend : 0.0F);
}

}  // namespace

CrossVesselSmoother::CrossVesselSmoother(const CrossVesselSmootherOptions& options) : options_(options) {}

void CrossVesselSmoother::smoothAcross(VesselPoints& points, const Frame& frame, const OcclusionMask& mask) const
{
  CrossProfile profile;
  for (VesselPoint& point : points) {
    const auto width = static_cast<float>(options_.width_share) * point.calibre;
    const int half = std::clamp(static_cast<int>(std::lround(width / 2.0F)), 1, kWidestHalf);
    const int farthest = options_.reach_px + half;
    if (!isInside(frame.contrast(), point, static_cast<float>(farthest + options_.along_px))) continue;
    measure(frame.contrast(), point, farthest, options_.along_px, profile);
    const std::optional<float> offset = darkest(profile, half, options_.reach_px);
    if (!offset) continue;
    const float x = point.x - *offset * std::sin(point.direction);
    const float y = point.y + *offset * std::cos(point.direction);
    if (!mask.isVisible(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)))) continue;
    point.x = x;
    point.y = y;
  }
}

}  // namespace eyeslam::tracking
