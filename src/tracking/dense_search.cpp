// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/dense_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "eyeslam/retina/vector_kernel.h"

namespace eyeslam::tracking {

namespace {

constexpr std::size_t kSums = 6;
constexpr int kRowLanes = 8;

// Adds n, a, b, aa, bb, ab over one row of cells that both sides know, lane by lane.
EYESLAM_VECTOR_KERNEL void correlateRow(const float* a, const float* a_known, const float* b, const float* b_known,
                                        int blocks, float* sums)
{
  for (int i = 0; i < blocks; ++i) {
    for (int k = 0; k < kRowLanes; ++k) {
      const int at = i * kRowLanes + k;
      const float w = a_known[at] * b_known[at];
      const float wa = w * a[at], wb = w * b[at];
      sums[k] += w;
      sums[1 * kRowLanes + k] += wa;
      sums[2 * kRowLanes + k] += wb;
      sums[3 * kRowLanes + k] += wa * a[at];
      sums[4 * kRowLanes + k] += wb * b[at];
      sums[5 * kRowLanes + k] += wa * b[at];
    }
  }
}

// Where between -0.5 and 0.5 a parabola through three values peaks.
double peak(double before, double here, double after)
{
  const double curvature = before + after - 2.0 * here;
  return curvature < 0.0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
}

}  // namespace

DenseSearch::DenseSearch(const DenseSearchOptions& options) : options_(options) {}

void DenseSearch::shrinkFrame(const MaskedContrast& frame, const retina::Pose2& around)
{
  // Columns in whole lanes; the cells beyond the view are unknown.
  const int rows = frame.height() / kCell;
  const int columns = (frame.width() / kCell + kRowLanes - 1) / kRowLanes * kRowLanes;
  frame_mean_.create(rows, columns);
  frame_known_.create(rows, columns);
  const Eigen::Matrix2d linear = retina::Pose2{0.0, 0.0, around.theta, around.scale}.inverse().linear();
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const Eigen::Vector2d p =
          frame.centre() + linear * Eigen::Vector2d((i + 0.5 - 0.5 * columns) * kCell, (j + 0.5 - 0.5 * rows) * kCell);
      const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
      const bool known = x >= kCell / 2 && y >= kCell / 2 && x + kCell / 2 < frame.width() &&
                         y + kCell / 2 < frame.height() && frame.isVisible(x, y);
      float sum = 0.0F;
      for (int v = y - kCell / 2; known && v < y + kCell / 2; ++v) {
        for (int u = x - kCell / 2; u < x + kCell / 2; ++u) sum += static_cast<float>(frame.contrast(v, u));
      }
      frame_mean_(j, i) = sum / (kCell * kCell);
      frame_known_(j, i) = known ? 1.0F : 0.0F;
    }
  }
}

void DenseSearch::shrinkMosaic(const Mosaic& mosaic, const retina::Pose2& around)
{
  const int rows = frame_mean_.rows + 2 * options_.reach_cells;
  const int columns = frame_mean_.cols + 2 * options_.reach_cells;
  const Eigen::Vector2d corner = mosaic.centre() + around.translation() - 0.5 * kCell * Eigen::Vector2d(columns, rows);
  const cv::Rect region(static_cast<int>(std::lround(corner.x())), static_cast<int>(std::lround(corner.y())),
                        columns * kCell, rows * kCell);
  mosaic.read(region, mean_, count_);
  mosaic_mean_.create(rows, columns);
  mosaic_known_.create(rows, columns);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      float sum = 0.0F, known = 0.0F;
      for (int v = j * kCell; v < (j + 1) * kCell; ++v) {
        for (int u = i * kCell; u < (i + 1) * kCell; ++u) {
          if (count_(v, u) == 0) continue;
          sum += static_cast<float>(mean_(v, u));
          known += 1.0F;
        }
      }
      mosaic_mean_(j, i) = known > 0.0F ? sum / known : 0.0F;
      mosaic_known_(j, i) = known > 0.5F * kCell * kCell ? 1.0F : 0.0F;
    }
  }
}

float DenseSearch::correlate(int dx, int dy) const
{
  std::array<float, kSums * kRowLanes> sums{};
  for (int j = 0; j < frame_mean_.rows; ++j) {
    correlateRow(frame_mean_[j], frame_known_[j], mosaic_mean_[j + dy] + dx, mosaic_known_[j + dy] + dx,
                 frame_mean_.cols / kRowLanes, sums.data());
  }
  std::array<double, kSums> s{};
  for (std::size_t i = 0; i < kSums; ++i) {
    for (std::size_t k = 0; k < kRowLanes; ++k) s[i] += static_cast<double>(sums[i * kRowLanes + k]);
  }
  // Little overlap correlates by chance.
  const double least = 0.2 * static_cast<double>(frame_mean_.total());
  const double power = (s[0] * s[3] - s[1] * s[1]) * (s[0] * s[4] - s[2] * s[2]);
  return s[0] >= least && power > 0.0 ? static_cast<float>((s[0] * s[5] - s[1] * s[2]) / std::sqrt(power)) : 0.0F;
}

std::optional<retina::Pose2> DenseSearch::find(const Mosaic& mosaic, const MaskedContrast& frame,
                                               const retina::Pose2& around)
{
  shrinkFrame(frame, around);
  shrinkMosaic(mosaic, around);
  const int reach = options_.reach_cells;
  float best = 0.0F;
  cv::Point at;
  for (int dy = 0; dy <= 2 * reach; ++dy) {
    for (int dx = 0; dx <= 2 * reach; ++dx) {
      const float ncc = correlate(dx, dy);
      if (ncc <= best) continue;
      best = ncc;
      at = {dx, dy};
    }
  }
  if (best < options_.least_ncc) return std::nullopt;
  const auto near = [&](int dx, int dy) {
    const int x = std::clamp(at.x + dx, 0, 2 * reach), y = std::clamp(at.y + dy, 0, 2 * reach);
    return static_cast<double>(correlate(x, y));
  };
  retina::Pose2 found = around;
  found.x += kCell * (at.x - reach + peak(near(-1, 0), static_cast<double>(best), near(1, 0)));
  found.y += kCell * (at.y - reach + peak(near(0, -1), static_cast<double>(best), near(0, 1)));
  return found;
}

}  // namespace eyeslam::tracking
