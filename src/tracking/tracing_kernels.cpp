// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/tracing_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "eyeslam/retina/units.h"
#include "eyeslam/tracking/frame.h"

namespace eyeslam::tracking {

namespace {

// Of a profile to either side: the derivative's half width.
constexpr int kProfileReach = TracingKernels::kFarthestEdge + 2;
constexpr int kProfile = 24;                      // 2 kProfileReach + 1, made a whole number of vectors
constexpr int kPadding = kProfileReach + 5;       // the reach and the shift of the farthest row
constexpr int kBrightest = Frame::kContrastUnit;  // clipped there, seven rows add up in 16 bits
constexpr int kShift = 3;                         // and an eighth of their sum can be weighted in 16 bits

static_assert(2 * kProfileReach + 1 <= kProfile);
static_assert(7 * kBrightest < 32768 && 6 * (7 * kBrightest >> kShift) < 32768);

using Profile = std::array<std::int16_t, kProfile>;
using Lanes = std::int16_t __attribute__((vector_size(16)));  // eight columns in one register, on any machine

inline Lanes load(const std::int16_t* from)
{
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

// An eighth of the sum over the template's rows; profile[kProfileReach + j] belongs to offset j from the middle.
inline void sumRows(const std::int16_t* first, std::ptrdiff_t step, const int* shift, int rows, Profile& profile)
{
  Lanes a{}, b{}, c{};
  for (int r = 0; r < rows; ++r) {
    const std::int16_t* row = first + r * step + shift[r];
    a += load(row);
    b += load(row + 8);
    c += load(row + 16);
  }
  a >>= kShift;
  b >>= kShift;
  c >>= kShift;
  std::memcpy(profile.data(), &a, sizeof a);
  std::memcpy(profile.data() + 8, &b, sizeof b);
  std::memcpy(profile.data() + 16, &c, sizeof c);
}

// The derivative (-1 -2 0 2 1) at eight neighbouring places; `at` is the profile at the first of them.
inline Lanes differentiate(const std::int16_t* at)
{
  const Lanes inner = load(at + 1) - load(at - 1);
  return load(at + 2) - load(at - 2) + inner + inner;
}

struct Edge {
  int slope;
  int offset;
};

// The steepest of eight slopes, lane i at offset i + 1. The lane rides in the low bits of the value, so that one
// maximum finds both, and the nearer edge wins a tie; three bits of some 20000 are far below the noise.
inline Edge steepest(Lanes slopes, int nearest, int farthest)
{
  constexpr Lanes kOffset = {1, 2, 3, 4, 5, 6, 7, 8};
  constexpr std::int16_t kLow = 7;
  const Lanes allowed =
      (kOffset >= static_cast<std::int16_t>(nearest)) & (kOffset <= static_cast<std::int16_t>(farthest));
  Lanes best = (slopes & static_cast<std::int16_t>(~kLow)) | ((kOffset - 1) ^ kLow);
  best = (best & allowed) | (std::numeric_limits<std::int16_t>::min() & ~allowed);
  const auto larger = [](Lanes a, Lanes b) { return a > b ? a : b; };
  best = larger(best, __builtin_shufflevector(best, best, 4, 5, 6, 7, 0, 1, 2, 3));
  best = larger(best, __builtin_shufflevector(best, best, 2, 3, 0, 1, 6, 7, 4, 5));
  best = larger(best, __builtin_shufflevector(best, best, 1, 0, 3, 2, 5, 4, 7, 6));
  return {best[0] & ~kLow, 1 + ((best[0] & kLow) ^ kLow)};
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
    const double dx = std::cos(o * kPi / kOrientations);
    const double dy = std::sin(o * kPi / kOrientations);
    shape.transposed = normalAxis(o).y() > 0.0F;
    const double along = std::max(std::abs(dx), std::abs(dy));
    const double slope = shape.transposed ? dy / dx : dx / dy;
    // An odd number of rows, so that the template lies even about its middle.
    const int half = static_cast<int>(std::lround((options.length_px * along - 1.0) / 2.0));
    shape.rows = 2 * half + 1;
    for (int r = 0; r < shape.rows; ++r)
      shape.shift[static_cast<std::size_t>(r)] = static_cast<int>(std::lround((r - half) * slope));
    shape.weight = (1 << (16 + kShift)) / (3 * shape.rows);
  }
}

void TracingKernels::assign(const cv::Mat_<std::int16_t>& plane)
{
  cv::copyMakeBorder(plane, upright_, kPadding, kPadding, kPadding, kPadding, cv::BORDER_REPLICATE);
  for (int y = 0; y < upright_.rows; ++y) {
    std::int16_t* row = upright_[y];
    for (int x = 0; x < upright_.cols; ++x) row[x] = std::min<std::int16_t>(row[x], kBrightest);
  }
  cv::transpose(upright_, transposed_);
}

VesselEdges TracingKernels::evaluate(int x, int y, int orientation, int nearest, int farthest) const
{
  const Template& shape = templates_[static_cast<std::size_t>(orientation)];
  const cv::Mat_<std::int16_t>& plane = shape.transposed ? transposed_ : upright_;
  const int column = (shape.transposed ? y : x) + kPadding - kProfileReach;
  const int row = (shape.transposed ? x : y) + kPadding - shape.rows / 2;
  Profile profile;
  sumRows(plane[row] + column, static_cast<std::ptrdiff_t>(plane.step1()), shape.shift.data(), shape.rows, profile);

  const std::int16_t* middle = profile.data() + kProfileReach;
  const Lanes falls = -differentiate(middle - kFarthestEdge);
  const Edge left = steepest(__builtin_shufflevector(falls, falls, 7, 6, 5, 4, 3, 2, 1, 0), nearest, farthest);
  const Edge right = steepest(differentiate(middle + 1), nearest, farthest);
  return {left.slope * shape.weight / (1 << 16), right.slope * shape.weight / (1 << 16), left.offset, right.offset};
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
