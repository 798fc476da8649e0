// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/view_canvas.h"

#include <cmath>

#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

// Dots in a square grid: the finest that a magnified print shows (rendered sequences: 4.83 px).
void printScreen(cv::Mat_<cv::Vec3f>& bgr, double strength)
{
  constexpr double kStep = kTwoPi / 4.83;
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x) {
      bgr(y, x) *= static_cast<float>(1.0 + strength * std::sin(kStep * x) * std::sin(kStep * y));
    }
  }
}

}  // namespace

cv::Mat canvasOf(const Fundus& fundus, cv::Rect area)
{
  cv::Mat canvas(area.size(), CV_32FC4);
  for (int y = 0; y < area.height; ++y) {
    for (int x = 0; x < area.width; ++x) {
      const cv::Vec3f& colour = fundus.bgr(area.y + y, area.x + x);
      canvas.at<cv::Vec4f>(y, x) = cv::Vec4f(colour[0], colour[1], colour[2], 0.0F);
    }
  }
  return canvas;
}

Fundus preparedFundus(const Fundus& fundus, const TissueOptions& tissue, double zoom)
{
  Fundus result = std::abs(zoom - 1.0) < 1e-9 ? fundus : resampled(fundus, zoom);
  if (!tissue.textured) result = withoutTexture(result);
  if (tissue.contrast != 1.0) result = withContrast(result, tissue.contrast);
  if (tissue.screen > 0.0) {
    result.bgr = result.bgr.clone();
    printScreen(result.bgr, tissue.screen);
  }
  return result;
}

}  // namespace eyeslam::simulation
