// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/ridge_detector.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "eyeslam/retina/vector_kernel.h"
#include "eyeslam/tracking/frame_kernels.h"

namespace eyeslam::tracking {

namespace {

struct Step {
  int dx, dy;
};
constexpr int kDirections = 4;
constexpr int kDistances = 3;
constexpr int kBorder = 5;
// Where the flanks lie, in half-frame px: 2, 3 and 5 away (rounded on the diagonals), across vessels that run
// up-down, along the falling diagonal's normal, left-right, along the rising diagonal's normal.
constexpr std::array<std::array<Step, kDistances>, kDirections> kFlanks = {{
    {{{2, 0}, {3, 0}, {5, 0}}},
    {{{1, 1}, {2, 2}, {4, 4}}},
    {{{0, 2}, {0, 3}, {0, 5}}},
    {{{-1, 1}, {-2, 2}, {-4, 4}}},
}};
constexpr std::array<Step, kDirections> kAcross = {{{1, 0}, {1, 1}, {0, 1}, {-1, 1}}};

EYESLAM_VECTOR_KERNEL void averagePairs(const std::int16_t* upper, const std::int16_t* lower, int count,
                                        std::int16_t* means)
{
  for (int i = 0; i < count; ++i) {
    means[i] = static_cast<std::int16_t>((upper[2 * i] + upper[2 * i + 1] + lower[2 * i] + lower[2 * i + 1] + 2) >> 2);
  }
}

// Keeps the larger of `response` and the depth below the lower flank, and the direction that gave it.
EYESLAM_VECTOR_KERNEL void ridgeRow(const std::int16_t* centre, const std::int16_t* flank, const std::int16_t* opposite,
                                    int count, std::int16_t direction, std::int16_t* response, std::int16_t* winner)
{
  for (int i = 0; i < count; ++i) {
    const auto depth = static_cast<std::int16_t>(std::min(flank[i], opposite[i]) - centre[i]);
    winner[i] = depth > response[i] ? direction : winner[i];
    response[i] = std::max(depth, response[i]);
  }
}

}  // namespace

RidgeDetector::RidgeDetector(const RidgeDetectorOptions& options)
    : options_(options), threshold_(static_cast<int>(options.least_contrast * Frame::kContrastUnit))
{}

void RidgeDetector::detect(const Frame& frame, const OcclusionMask& mask, VesselPoints& points)
{
  shrink(frame);
  respond();
  points.clear();
  collect(mask, points);
  keepStrongest(points);
}

void RidgeDetector::shrink(const Frame& frame)
{
  const cv::Mat_<std::int16_t>& contrast = frame.contrast();
  const cv::Size half(contrast.cols / 2, contrast.rows / 2);
  for (auto* plane : {&small_, &smooth_, &response_, &direction_}) plane->create(half);
  scratch_.resize(static_cast<std::size_t>(half.width) + 2);
  for (int y = 0; y < half.height; ++y) averagePairs(contrast[2 * y], contrast[2 * y + 1], half.width, small_[y]);
  for (int y = 0; y < half.height; ++y) {
    kernels::smoothRow(small_[std::max(y - 1, 0)], small_[y], small_[std::min(y + 1, half.height - 1)], half.width,
                       scratch_.data(), smooth_[y]);
  }
}

void RidgeDetector::respond()
{
  for (int y = 0; y < response_.rows; ++y) std::fill_n(response_[y], response_.cols, 0);  // setTo would allocate
  const int count = smooth_.cols - 2 * kBorder;
  for (int y = kBorder; y < smooth_.rows - kBorder; ++y) {
    for (int direction = 0; direction < kDirections; ++direction) {
      for (const Step& step : kFlanks[static_cast<std::size_t>(direction)]) {
        ridgeRow(smooth_[y] + kBorder, smooth_[y + step.dy] + kBorder + step.dx,
                 smooth_[y - step.dy] + kBorder - step.dx, count, static_cast<std::int16_t>(direction),
                 response_[y] + kBorder, direction_[y] + kBorder);
      }
    }
  }
}

void RidgeDetector::collect(const OcclusionMask& mask, VesselPoints& points) const
{
  constexpr auto kUnit = static_cast<float>(Frame::kContrastUnit);
  for (int y = kBorder; y < response_.rows - kBorder; ++y) {
    const std::int16_t* row = response_[y];
    for (int x = kBorder; x < response_.cols - kBorder; ++x) {
      if (row[x] < threshold_ || !mask.isVisible(2 * x, 2 * y)) continue;
      const Step across = kAcross[static_cast<std::size_t>(direction_(y, x))];
      const int before = smooth_(y - across.dy, x - across.dx);
      const int after = smooth_(y + across.dy, x + across.dx);
      const int here = smooth_(y, x);
      if (here > before || here >= after) continue;  // the darkest across the vessel stands for it
      const float offset = 0.5F * static_cast<float>(before - after) / static_cast<float>(before + after - 2 * here);
      points.push_back({2.0F * (static_cast<float>(x) + offset * static_cast<float>(across.dx)) + 0.5F,
                        2.0F * (static_cast<float>(y) + offset * static_cast<float>(across.dy)) + 0.5F,
                        static_cast<float>(row[x]) / kUnit,
                        std::atan2(static_cast<float>(across.dx), -static_cast<float>(across.dy)), 0.0F});
    }
  }
}

void RidgeDetector::keepStrongest(VesselPoints& points)
{
  const auto most = static_cast<std::size_t>(options_.most_points);
  const int floor = static_cast<int>(options_.least_contrast * Frame::kContrastUnit);
  if (points.size() > most) {
    // Ties go to the upper, then the left point: the order of equal elements must not depend on the library.
    const auto stronger = [](const VesselPoint& a, const VesselPoint& b) {
      if (a.strength != b.strength) return a.strength > b.strength;
      return a.y != b.y ? a.y < b.y : a.x < b.x;
    };
    std::nth_element(points.begin(), points.begin() + options_.most_points, points.end(), stronger);
    const float next = points[most].strength;
    points.resize(most);
    // A little below the last one taken, so that the next frame has some to choose from.
    threshold_ = std::max(floor, static_cast<int>(0.9F * next * Frame::kContrastUnit));
  } else {
    threshold_ = std::max(floor, threshold_ * 3 / 4);
  }
}

}  // namespace eyeslam::tracking
