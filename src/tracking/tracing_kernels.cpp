// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/tracing_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace eyeslam::tracking {

namespace {

constexpr int kReach = TracingKernels::kFarthestEdge + 2;  // of a profile to either side: the derivative's half width
constexpr int kProfile = 24;                               // 2 kReach + 1, made a whole number of vectors
constexpr int kMargin = kReach + 5;                        // padding: the reach and the shift of the farthest row

static_assert(2 * kReach + 1 <= kProfile);

using Profile = std::array<int, kProfile>;

// Sum over the template's rows; profile[kReach + j] belongs to offset j from the middle.
inline void sumRows(const std::int16_t* first, std::ptrdiff_t step, const int* shift, int rows, Profile& profile)
{
  profile.fill(0);
  for (int r = 0; r < rows; ++r) {
    const std::int16_t* row = first + r * step + shift[r];
    for (int j = 0; j < kProfile; ++j) profile[static_cast<std::size_t>(j)] += row[j];
  }
}

}  // namespace

TracingKernels::TracingKernels(const TracingKernelOptions& options)
{
  for (int d = 0; d < kDirections; ++d) {
    const double angle = d * CV_2PI / kDirections;
    directions_[static_cast<std::size_t>(d)] = Eigen::Vector2d(std::cos(angle), std::sin(angle)).cast<float>();
  }
  for (int o = 0; o < kOrientations; ++o) {
    Template& shape = templates_[static_cast<std::size_t>(o)];
    const double dx = std::cos(o * CV_PI / kOrientations);
    const double dy = std::sin(o * CV_PI / kOrientations);
    shape.transposed = normalAxis(o).y() > 0.0F;
    const double along = std::max(std::abs(dx), std::abs(dy));
    const double slope = shape.transposed ? dy / dx : dx / dy;
    // An odd number of rows, so that the template lies even about its middle.
    const int half = static_cast<int>(std::lround((options.length_px * along - 1.0) / 2.0));
    shape.rows = 2 * half + 1;
    for (int r = 0; r < shape.rows; ++r)
      shape.shift[static_cast<std::size_t>(r)] = static_cast<int>(std::lround((r - half) * slope));
    shape.weight = (1 << 16) / (3 * shape.rows);
  }
}

void TracingKernels::assign(const cv::Mat_<std::int16_t>& plane)
{
  cv::copyMakeBorder(plane, upright_, kMargin, kMargin, kMargin, kMargin, cv::BORDER_REPLICATE);
  cv::transpose(upright_, transposed_);
}

VesselEdges TracingKernels::evaluate(int x, int y, int orientation, int nearest, int farthest) const
{
  const Template& shape = templates_[static_cast<std::size_t>(orientation)];
  const cv::Mat_<std::int16_t>& plane = shape.transposed ? transposed_ : upright_;
  const int column = (shape.transposed ? y : x) + kMargin - kReach;
  const int row = (shape.transposed ? x : y) + kMargin - shape.rows / 2;
  Profile profile;
  sumRows(plane[row] + column, static_cast<std::ptrdiff_t>(plane.step1()), shape.shift.data(), shape.rows, profile);

  const int* middle = profile.data() + kReach;
  const auto slope = [&](int at) { return middle[at + 2] + 2 * middle[at + 1] - 2 * middle[at - 1] - middle[at - 2]; };
  VesselEdges edges;
  int left = slope(-nearest);
  int right = slope(nearest);
  edges.left_offset = edges.right_offset = nearest;
  for (int k = nearest + 1; k <= farthest; ++k) {
    if (const int rise = slope(k); rise > right) right = rise, edges.right_offset = k;
    if (const int fall = slope(-k); fall < left) left = fall, edges.left_offset = k;
  }
  edges.left = -left * shape.weight / (1 << 16);
  edges.right = right * shape.weight / (1 << 16);
  return edges;
}

Eigen::Vector2f TracingKernels::normalAxis(int orientation)
{
  // At 45 and 135 degrees both axes are as near; either serves.
  const bool steep = orientation >= 2 && orientation <= 6;
  return steep ? Eigen::Vector2f(1.0F, 0.0F) : Eigen::Vector2f(0.0F, 1.0F);
}

float TracingKernels::widthPerStep(int orientation) const
{
  const Eigen::Vector2f& along = direction(orientation);
  return std::max(std::abs(along.x()), std::abs(along.y()));
}

}  // namespace eyeslam::tracking
