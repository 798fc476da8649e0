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

// Weights x those 4 x 4 pixels of four colours, the rows at `rows`.
struct Taps {
  std::array<const float*, 4> rows;
  std::array<float, 4> across, down;
};

// Four colours of a pixel, and those of two side by side: the compiler does not find these vectors by itself.
using OnePixel = float __attribute__((vector_size(16)));
using TwoPixels = float __attribute__((vector_size(32)));

// By reference, since the two clones of a kernel would hand vectors over in different ways.
inline void readTwo(const Taps& taps, std::size_t first, TwoPixels& down)
{
  std::array<TwoPixels, 4> row;
  for (std::size_t k = 0; k < 4; ++k) std::memcpy(&row[k], taps.rows[k] + first, sizeof(TwoPixels));
  down = taps.down[0] * row[0] + taps.down[1] * row[1] + taps.down[2] * row[2] + taps.down[3] * row[3];
}

inline void addTaps(const Taps& taps, float weight, float* __restrict out)
{
  TwoPixels left, right;
  readTwo(taps, 0, left);
  readTwo(taps, 8, right);
  const OnePixel sum = taps.across[0] * __builtin_shufflevector(left, left, 0, 1, 2, 3) +
                       taps.across[1] * __builtin_shufflevector(left, left, 4, 5, 6, 7) +
                       taps.across[2] * __builtin_shufflevector(right, right, 0, 1, 2, 3) +
                       taps.across[3] * __builtin_shufflevector(right, right, 4, 5, 6, 7);
  OnePixel pixel;
  std::memcpy(&pixel, out, sizeof pixel);
  pixel += weight * sum;
  std::memcpy(out, &pixel, sizeof pixel);
}

// At the canvas's border the pixels beyond it are those on it.
void addAtBorder(const cv::Mat& canvas, int x, int y, Taps taps, float weight, float* out)
{
  std::array<float, 64> pixels;
  for (int j = 0; j < 4; ++j) {
    const float* row = canvas.ptr<float>(std::clamp(y + j - 1, 0, canvas.rows - 1));
    float* copy = pixels.data() + 16 * j;
    for (int i = 0; i < 4; ++i) std::copy_n(row + 4 * std::clamp(x + i - 1, 0, canvas.cols - 1), 4, copy + 4 * i);
    taps.rows[static_cast<std::size_t>(j)] = copy;
  }
  addTaps(taps, weight, out);
}

EYESLAM_VECTOR_KERNEL void addRow(const cv::Mat& canvas, const RowPlaces& across, const RowPlaces& down,
                                  std::size_t columns, float weight, float* out)
{
  const std::size_t step = canvas.step1();
  for (std::size_t i = 0; i < columns; ++i, out += 4) {
    const int x = across.whole[i], y = down.whole[i];
    Taps taps;
    for (std::size_t k = 0; k < 4; ++k) {
      taps.across[k] = across.weights[k][i];
      taps.down[k] = down.weights[k][i];
    }
    if (x < 1 || y < 1 || x >= canvas.cols - 2 || y >= canvas.rows - 2) {
      addAtBorder(canvas, x, y, taps, weight, out);
      continue;
    }
    const float* row = canvas.ptr<float>(y - 1) + 4 * (x - 1);
    taps.rows = {row, row + step, row + 2 * step, row + 3 * step};
    addTaps(taps, weight, out);
  }
}

}  // namespace

void accumulateView(const cv::Mat& canvas, const ViewMapping& mapping, float weight, cv::Mat& view)
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
      addRow(canvas, across, down, static_cast<std::size_t>(columns), weight, view.ptr<float>(row) + 4 * first);
    }
  }
}

}  // namespace eyeslam::simulation
