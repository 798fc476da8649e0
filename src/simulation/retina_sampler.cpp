// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/retina_sampler.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstring>

#include "eyeslam/retina/vector_kernel.h"

namespace eyeslam::simulation {

namespace {

constexpr int kFarAway_px = 1 << 20;
constexpr std::size_t kChunk = 256;  // pixels of a row: their weights stay in the fastest cache

// Where pixels of a row lie along one axis of the canvas: whole pixels, and the weights of the four about each.
struct RowPlaces {
  std::array<int, kChunk> whole;
  std::array<std::array<float, kChunk>, 4> weights;
};

// Position along the row, px: constant + linear dx + square dx^2.
struct RowCurve {
  double constant, linear, square;
};

// Catmull-Rom: reproduces straight ramps exactly, so that nothing shifts.
EYESLAM_VECTOR_KERNEL void locate(const RowCurve& curve, double first_dx, int columns, int* __restrict whole,
                                  float* __restrict before, float* __restrict at, float* __restrict after,
                                  float* __restrict beyond)
{
  for (int i = 0; i < columns; ++i) {
    const double dx = first_dx + i;
    const double q = curve.constant + dx * (curve.linear + dx * curve.square);
    // A floor without a call: views stay within a million px of the canvas.
    whole[i] = static_cast<int>(q + kFarAway_px) - kFarAway_px;
    const auto t = static_cast<float>(q - whole[i]);
    const float u = 1.0F - t;
    before[i] = -0.5F * t * u * u;
    at[i] = 1.0F + t * t * (1.5F * t - 2.5F);
    after[i] = 1.0F + u * u * (1.5F * u - 2.5F);
    beyond[i] = -0.5F * u * t * t;
  }
}

void locate(const RowCurve& curve, double first_dx, int columns, RowPlaces& places)
{
  auto& w = places.weights;
  locate(curve, first_dx, columns, places.whole.data(), w[0].data(), w[1].data(), w[2].data(), w[3].data());
}

// Four colours of a pixel: the widest vector that every x86-64 has, for others are taken apart before the kernel's
// clones are made.
using OnePixel = float __attribute__((vector_size(16)));

inline OnePixel pixelAt(const float* from)
{
  OnePixel pixel;
  std::memcpy(&pixel, from, sizeof pixel);
  return pixel;
}

// Weights x those 4 x 4 pixels of four colours, the rows at `rows`.
struct Taps {
  std::array<const float*, 4> rows;
  std::array<float, 4> across, down;
};

inline void addTaps(const Taps& taps, const Share& share, float* __restrict out)
{
  std::array<OnePixel, 4> column;
  for (std::size_t k = 0; k < 4; ++k) {
    column[k] = taps.down[0] * pixelAt(taps.rows[0] + 4 * k) + taps.down[1] * pixelAt(taps.rows[1] + 4 * k) +
                taps.down[2] * pixelAt(taps.rows[2] + 4 * k) + taps.down[3] * pixelAt(taps.rows[3] + 4 * k);
  }
  const OnePixel before = share.is_first ? OnePixel{} : pixelAt(out);
  const OnePixel pixel = before + share.weight * (taps.across[0] * column[0] + taps.across[1] * column[1] +
                                                  taps.across[2] * column[2] + taps.across[3] * column[3]);
  std::memcpy(out, &pixel, sizeof pixel);
}

inline Taps tapsOf(const RowPlaces& across, const RowPlaces& down, std::size_t i)
{
  return {{},
          {across.weights[0][i], across.weights[1][i], across.weights[2][i], across.weights[3][i]},
          {down.weights[0][i], down.weights[1][i], down.weights[2][i], down.weights[3][i]}};
}

// At the canvas's border the pixels beyond it are those on it.
void addAtBorder(const cv::Mat& canvas, int x, int y, Taps taps, const Share& share, float* out)
{
  std::array<float, 64> pixels;
  for (int j = 0; j < 4; ++j) {
    const float* row = canvas.ptr<float>(std::clamp(y + j - 1, 0, canvas.rows - 1));
    float* copy = pixels.data() + 16 * j;
    for (int i = 0; i < 4; ++i) std::copy_n(row + 4 * std::clamp(x + i - 1, 0, canvas.cols - 1), 4, copy + 4 * i);
    taps.rows[static_cast<std::size_t>(j)] = copy;
  }
  addTaps(taps, share, out);
}

// Whether all four about each place are on an axis of the canvas, so long.
EYESLAM_VECTOR_KERNEL bool areInside(const int* whole, int columns, int length)
{
  int low = length, high = 0;
  for (int i = 0; i < columns; ++i) {
    low = std::min(low, whole[i]);
    high = std::max(high, whole[i]);
  }
  return low >= 1 && high < length - 2;
}

EYESLAM_VECTOR_KERNEL void addInside(const float* canvas, std::ptrdiff_t step, const RowPlaces& across,
                                     const RowPlaces& down, std::size_t columns, const Share& share,
                                     float* __restrict out)
{
  for (std::size_t i = 0; i < columns; ++i, out += 4) {
    const float* row = canvas + (down.whole[i] - 1) * step + 4 * (across.whole[i] - 1);
    Taps taps = tapsOf(across, down, i);
    taps.rows = {row, row + step, row + 2 * step, row + 3 * step};
    addTaps(taps, share, out);
  }
}

void addRow(const cv::Mat& canvas, const RowPlaces& across, const RowPlaces& down, int columns, const Share& share,
            float* out)
{
  if (areInside(across.whole.data(), columns, canvas.cols) && areInside(down.whole.data(), columns, canvas.rows)) {
    addInside(canvas.ptr<float>(), static_cast<std::ptrdiff_t>(canvas.step1()), across, down,
              static_cast<std::size_t>(columns), share, out);
    return;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(columns); ++i) {
    addAtBorder(canvas, across.whole[i], down.whole[i], tapsOf(across, down, i), share, out + 4 * i);
  }
}

}  // namespace

void accumulateView(const cv::Mat& canvas, const ViewMapping& mapping, const Share& share, cv::Mat& view)
{
  CV_Assert(canvas.type() == CV_32FC4 && view.type() == CV_32FC4 && canvas.cols >= 4 && canvas.rows >= 4);
  const Eigen::Matrix2d linear = mapping.map_T_frame.linear();
  const Eigen::Vector2d centre((view.cols - 1) / 2.0, (view.rows - 1) / 2.0);
  const Eigen::Vector2d origin(mapping.map_origin.x, mapping.map_origin.y);
  const Eigen::Vector2d offset = centre + mapping.map_T_frame.translation() - origin;
  const auto& w = mapping.warp;
  RowPlaces across, down;
  for (int row = 0; row < view.rows; ++row) {
    const double dy = row - centre.y();
    const RowCurve x{offset.x() + linear(0, 1) * dy + w[2] * dy * dy, linear(0, 0) + w[1] * dy, w[0]};
    const RowCurve y{offset.y() + linear(1, 1) * dy + w[5] * dy * dy, linear(1, 0) + w[4] * dy, w[3]};
    for (int first = 0; first < view.cols; first += static_cast<int>(kChunk)) {
      const int columns = std::min(static_cast<int>(kChunk), view.cols - first);
      locate(x, first - centre.x(), columns, across);
      locate(y, first - centre.x(), columns, down);
      addRow(canvas, across, down, columns, share, view.ptr<float>(row) + 4 * first);
    }
  }
}

}  // namespace eyeslam::simulation
