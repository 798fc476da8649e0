// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/retina_sampler.h"

#include <Eigen/Core>
#include <algorithm>

namespace eyeslam::simulation {

namespace {

using Colour = Eigen::Array4f;
using Weights = std::array<float, 4>;
constexpr int kFarAway_px = 1 << 20;

// Catmull-Rom: reproduces straight ramps exactly, so that nothing shifts.
Weights cubicWeights(float t)
{
  const float u = 1.0F - t;
  return {-0.5F * t * u * u, 1.0F + t * t * (1.5F * t - 2.5F), 1.0F + u * u * (1.5F * u - 2.5F), -0.5F * u * t * t};
}

Colour pixelAt(const cv::Mat& canvas, int x, int y) { return Eigen::Map<const Colour>(canvas.ptr<float>(y) + 4 * x); }

Colour sampleInside(const cv::Mat& canvas, int x, int y, const Weights& wx, const Weights& wy)
{
  Colour sum = Colour::Zero();
  for (int j = 0; j < 4; ++j) {
    const float* row = canvas.ptr<float>(y + j - 1) + 4 * (x - 1);
    const Colour line = wx[0] * Eigen::Map<const Colour>(row) + wx[1] * Eigen::Map<const Colour>(row + 4) +
                        wx[2] * Eigen::Map<const Colour>(row + 8) + wx[3] * Eigen::Map<const Colour>(row + 12);
    sum += wy[static_cast<std::size_t>(j)] * line;
  }
  return sum;
}

Colour sampleAtBorder(const cv::Mat& canvas, int x, int y, const Weights& wx, const Weights& wy)
{
  Colour sum = Colour::Zero();
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const int column = std::clamp(x + i - 1, 0, canvas.cols - 1);
      const int row = std::clamp(y + j - 1, 0, canvas.rows - 1);
      sum += wx[static_cast<std::size_t>(i)] * wy[static_cast<std::size_t>(j)] * pixelAt(canvas, column, row);
    }
  }
  return sum;
}

Colour sample(const cv::Mat& canvas, double qx, double qy)
{
  // A floor without a call: views stay within a million px of the canvas.
  const int x = static_cast<int>(qx + kFarAway_px) - kFarAway_px;
  const int y = static_cast<int>(qy + kFarAway_px) - kFarAway_px;
  const Weights wx = cubicWeights(static_cast<float>(qx - x));
  const Weights wy = cubicWeights(static_cast<float>(qy - y));
  const bool inside = x >= 1 && y >= 1 && x < canvas.cols - 2 && y < canvas.rows - 2;
  return inside ? sampleInside(canvas, x, y, wx, wy) : sampleAtBorder(canvas, x, y, wx, wy);
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
  for (int row = 0; row < view.rows; ++row) {
    float* out = view.ptr<float>(row);
    const double dy = row - centre.y();
    for (int column = 0; column < view.cols; ++column, out += 4) {
      const double dx = column - centre.x();
      const double qx =
          offset.x() + linear(0, 0) * dx + linear(0, 1) * dy + w[0] * dx * dx + w[1] * dx * dy + w[2] * dy * dy;
      const double qy =
          offset.y() + linear(1, 0) * dx + linear(1, 1) * dy + w[3] * dx * dx + w[4] * dx * dy + w[5] * dy * dy;
      Eigen::Map<Colour>(out) += weight * sample(canvas, qx, qy);
    }
  }
}

}  // namespace eyeslam::simulation
