// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/retina_sampler.h"

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "eyeslam/retina/vector_kernel.h"

namespace eyeslam::simulation {

namespace {

constexpr int kFarAway_px = 1 << 20;

// Where a row of the view lies along one axis of the canvas: whole pixels, and the weights of the four about each.
struct RowPlaces {
  explicit RowPlaces(int columns) : whole(static_cast<std::size_t>(columns))
  {
    for (auto& weight : weights) weight.resize(whole.size());
  }
  std::vector<int> whole;
  std::array<std::vector<float>, 4> weights;
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

void locate(const RowCurve& curve, double first_dx, RowPlaces& places)
{
  auto& w = places.weights;
  locate(curve, first_dx, static_cast<int>(places.whole.size()), places.whole.data(), w[0].data(), w[1].data(),
         w[2].data(), w[3].data());
}

// Weights x those 4 x 4 pixels of four colours, the rows at `rows`.
struct Taps {
  std::array<const float*, 4> rows;
  std::array<float, 4> across, down;
};

inline void addTaps(const Taps& taps, float weight, float* __restrict out)
{
  std::array<float, 16> line;
  for (std::size_t k = 0; k < 16; ++k) {
    line[k] = taps.down[0] * taps.rows[0][k] + taps.down[1] * taps.rows[1][k] + taps.down[2] * taps.rows[2][k] +
              taps.down[3] * taps.rows[3][k];
  }
  for (std::size_t c = 0; c < 4; ++c) {
    out[c] += weight * (taps.across[0] * line[c] + taps.across[1] * line[c + 4] + taps.across[2] * line[c + 8] +
                        taps.across[3] * line[c + 12]);
  }
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

EYESLAM_VECTOR_KERNEL void addRow(const cv::Mat& canvas, const RowPlaces& across, const RowPlaces& down, float weight,
                                  float* out)
{
  const std::size_t step = canvas.step1();
  for (std::size_t i = 0; i < across.whole.size(); ++i, out += 4) {
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
  RowPlaces across(view.cols), down(view.cols);
  for (int row = 0; row < view.rows; ++row) {
    const double dy = row - centre.y();
    locate({offset.x() + linear(0, 1) * dy + w[2] * dy * dy, linear(0, 0) + w[1] * dy, w[0]}, -centre.x(), across);
    locate({offset.y() + linear(1, 1) * dy + w[5] * dy * dy, linear(1, 0) + w[4] * dy, w[3]}, -centre.x(), down);
    addRow(canvas, across, down, weight, view.ptr<float>(row));
  }
}

}  // namespace eyeslam::simulation
