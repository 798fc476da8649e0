// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/fundus.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace eyeslam::simulation {

namespace {

constexpr double kMean_um = 200.0;       // sigma of the local mean
constexpr double kNoTexture_um = 260.0;  // sigma of a background that keeps disc and macula only

// A wide Gaussian costs less on a smaller picture, and nothing of it is lost.
cv::Mat wideBlur(const cv::Mat& picture, double sigma_px)
{
  const double shrink = std::max(1.0, sigma_px / 6.0);
  cv::Mat small;
  cv::Mat wide;
  cv::resize(picture, small, {}, 1.0 / shrink, 1.0 / shrink, cv::INTER_AREA);
  cv::GaussianBlur(small, small, {}, sigma_px / shrink);
  cv::resize(small, wide, picture.size(), 0, 0, cv::INTER_LINEAR);
  return wide;
}

struct Weighted {
  cv::Mat_<cv::Vec3f> sum;
  cv::Mat_<float> weight;
};

cv::Mat_<cv::Vec3f> divided(const Weighted& weighted)
{
  cv::Mat_<cv::Vec3f> result(weighted.sum.size());
  for (int y = 0; y < result.rows; ++y) {
    for (int x = 0; x < result.cols; ++x) {
      result(y, x) = weighted.sum(y, x) / std::max(weighted.weight(y, x), 1e-6F);
    }
  }
  return result;
}

Weighted weightedBy(const cv::Mat_<cv::Vec3f>& picture, const cv::Mat_<std::uint8_t>& mask)
{
  Weighted weighted{cv::Mat_<cv::Vec3f>(picture.size(), cv::Vec3f::all(0.0F)), cv::Mat_<float>(picture.size(), 0.0F)};
  picture.copyTo(weighted.sum, mask);
  weighted.weight.setTo(1.0, mask);
  return weighted;
}

// Pull: what a level does not know is asked of the next coarser one. Push: blended in by how little is known.
Weighted pulledAndPushed(const Weighted& fine)
{
  if (std::min(fine.sum.cols, fine.sum.rows) < 4) return fine;
  Weighted coarse;
  cv::resize(fine.sum, coarse.sum, {}, 0.5, 0.5, cv::INTER_AREA);
  cv::resize(fine.weight, coarse.weight, {}, 0.5, 0.5, cv::INTER_AREA);
  const Weighted below = pulledAndPushed(coarse);
  Weighted up;
  cv::resize(below.sum, up.sum, fine.sum.size(), 0, 0, cv::INTER_LINEAR);
  cv::resize(below.weight, up.weight, fine.sum.size(), 0, 0, cv::INTER_LINEAR);
  Weighted result{fine.sum.clone(), fine.weight.clone()};
  for (int y = 0; y < result.sum.rows; ++y) {
    for (int x = 0; x < result.sum.cols; ++x) {
      const float missing = 1.0F - std::min(1.0F, fine.weight(y, x));
      const float scale = missing / std::max(up.weight(y, x), 1e-6F);
      result.sum(y, x) += up.sum(y, x) * scale;
      result.weight(y, x) += up.weight(y, x) * scale;
    }
  }
  return result;
}

}  // namespace

cv::Mat_<cv::Vec3f> filledIn(const cv::Mat_<cv::Vec3f>& picture, const cv::Mat_<std::uint8_t>& known)
{
  cv::Mat_<cv::Vec3f> result = divided(pulledAndPushed(weightedBy(picture, known)));
  picture.copyTo(result, known);
  return result;
}

Fundus resampled(const Fundus& fundus, double zoom)
{
  const cv::Size size(cvRound(fundus.bgr.cols * zoom), cvRound(fundus.bgr.rows * zoom));
  Fundus result;
  cv::resize(fundus.bgr, result.bgr, size, 0, 0, zoom < 1.0 ? cv::INTER_AREA : cv::INTER_CUBIC);
  cv::resize(fundus.calibre_px, result.calibre_px, size, 0, 0, cv::INTER_NEAREST);
  cv::resize(fundus.known, result.known, size, 0, 0, cv::INTER_NEAREST);
  result.calibre_px *= zoom;
  result.um_per_px = fundus.um_per_px / zoom;
  return result;
}

Fundus withoutTexture(const Fundus& fundus)
{
  const cv::Mat_<std::uint8_t> vessel(fundus.calibre_px > 0.0F);
  cv::Mat grown;
  cv::dilate(vessel, grown, cv::getStructuringElement(cv::MORPH_ELLIPSE, {9, 9}));
  const cv::Mat_<cv::Vec3f> between =
      wideBlur(filledIn(fundus.bgr, cv::Mat_<std::uint8_t>(~grown)), 20.0 / fundus.um_per_px);
  const cv::Mat_<cv::Vec3f> plain = wideBlur(between, kNoTexture_um / fundus.um_per_px);
  cv::Mat_<float> soft;
  vessel.convertTo(soft, CV_32F, 1.0 / 255.0);
  cv::dilate(soft, soft, cv::getStructuringElement(cv::MORPH_ELLIPSE, {3, 3}));
  cv::GaussianBlur(soft, soft, {}, 1.2);
  Fundus result = fundus;
  result.bgr = plain.clone();
  for (int y = 0; y < plain.rows; ++y) {
    for (int x = 0; x < plain.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float darkness = std::min(1.0F, fundus.bgr(y, x)[c] / std::max(between(y, x)[c], 1e-3F)) - 1.0F;
        result.bgr(y, x)[c] *= 1.0F + soft(y, x) * darkness;
      }
    }
  }
  return result;
}

Fundus withContrast(const Fundus& fundus, double factor)
{
  Fundus result = fundus;
  const cv::Mat mean = wideBlur(fundus.bgr, kMean_um / fundus.um_per_px);
  // A new picture: assigning the expression to the shared one would write into the caller's.
  const cv::Mat contrasted = mean + factor * (fundus.bgr - mean);
  result.bgr = contrasted;
  return result;
}

}  // namespace eyeslam::simulation
