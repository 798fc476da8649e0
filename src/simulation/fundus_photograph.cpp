// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/fundus_photograph.h"

#include <array>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

namespace eyeslam::simulation {

namespace {

constexpr int kSmallest_px = 64;

void check(const cv::Mat& bgr, const cv::Mat& vessels)
{
  if (bgr.type() != CV_8UC3 || bgr.cols < kSmallest_px || bgr.rows < kSmallest_px) {
    throw std::invalid_argument("the photograph must be a colour picture of 8 bit and at least 64 x 64 px");
  }
  if (vessels.empty()) return;
  if (vessels.type() != CV_8UC1 || vessels.size() != bgr.size()) {
    throw std::invalid_argument("the vessel mask must have one channel of 8 bit and the photograph's size, " +
                                std::to_string(bgr.cols) + "x" + std::to_string(bgr.rows));
  }
}

// The field of view: the largest bright region, without holes, less a seam.
cv::Mat_<std::uint8_t> fieldOfView(const cv::Mat& bgr, const FundusPhotographOptions& options)
{
  std::array<cv::Mat, 3> channels;
  cv::split(bgr, channels.data());
  cv::Mat bright;
  cv::blur(channels[2], bright, {9, 9});
  bright = bright > options.surround_level;
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(bright, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  if (outlines.empty()) throw std::invalid_argument("the photograph is dark everywhere");
  const auto larger = [](const auto& a, const auto& b) { return cv::contourArea(a) < cv::contourArea(b); };
  const auto largest = std::max_element(outlines.begin(), outlines.end(), larger);
  cv::Mat_<std::uint8_t> field(bgr.size(), std::uint8_t{0});
  cv::drawContours(field, outlines, static_cast<int>(largest - outlines.begin()), cv::Scalar(255), cv::FILLED);
  // A picture without surround loses nothing: its edge is not an edge of the field.
  cv::Mat bordered;
  cv::copyMakeBorder(field, bordered, 1, 1, 1, 1, cv::BORDER_REPLICATE);
  cv::Mat distance;
  cv::distanceTransform(bordered, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return cv::Mat_<std::uint8_t>(distance(cv::Rect({1, 1}, field.size())) > options.margin_um / options.um_per_px);
}

// A centre has no longer distance on either side of at least one line through it, and a shorter one on one of them.
bool isCentre(const cv::Mat_<float>& distance, int x, int y)
{
  constexpr std::array<std::array<int, 2>, 4> kDirections = {{{1, 0}, {1, 1}, {0, 1}, {-1, 1}}};
  const float here = distance(y, x);
  for (const auto& [dx, dy] : kDirections) {
    const float before = distance(y - dy, x - dx);
    const float after = distance(y + dy, x + dx);
    if (here >= before && here >= after && 2.0F * here - before - after > 0.7F) return true;
  }
  return false;
}

}  // namespace

cv::Mat_<float> calibreOfMask(const cv::Mat_<std::uint8_t>& vessels)
{
  cv::Mat_<float> calibre(vessels.size(), 0.0F);
  if (cv::countNonZero(vessels) == 0) return calibre;
  cv::Mat_<float> distance;
  cv::distanceTransform(vessels, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Mat_<std::uint8_t> off_centre(vessels.size(), std::uint8_t{255});
  for (int y = 1; y + 1 < vessels.rows; ++y) {
    for (int x = 1; x + 1 < vessels.cols; ++x) {
      if (vessels(y, x) && isCentre(distance, x, y)) off_centre(y, x) = 0;
    }
  }
  if (cv::countNonZero(off_centre) == static_cast<int>(off_centre.total())) return calibre;
  cv::Mat to_centre;
  cv::Mat_<int> nearest;
  cv::distanceTransform(off_centre, to_centre, nearest, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
  std::vector<float> radius(vessels.total() + 1, 0.0F);
  for (int y = 0; y < vessels.rows; ++y) {
    for (int x = 0; x < vessels.cols; ++x) {
      if (!off_centre(y, x)) radius[static_cast<std::size_t>(nearest(y, x))] = distance(y, x);
    }
  }
  // A line one pixel wide has distance 1 at its centre: half a pixel belongs to either side.
  for (int y = 0; y < vessels.rows; ++y) {
    for (int x = 0; x < vessels.cols; ++x) {
      if (vessels(y, x)) calibre(y, x) = 2.0F * radius[static_cast<std::size_t>(nearest(y, x))] - 1.0F;
    }
  }
  return calibre;
}

Fundus fundusFromPhotograph(const cv::Mat& bgr, const cv::Mat& vessels, const FundusPhotographOptions& options)
{
  check(bgr, vessels);
  Fundus fundus;
  fundus.um_per_px = options.um_per_px;
  fundus.known = fieldOfView(bgr, options);
  if (cv::countNonZero(fundus.known) == 0) throw std::invalid_argument("the photograph shows too little retina");
  cv::Mat_<cv::Vec3f> colour;
  bgr.convertTo(colour, CV_32F, 1.0 / 255.0);
  fundus.bgr = filledIn(colour, fundus.known);
  fundus.calibre_px = cv::Mat_<float>(bgr.size(), 0.0F);
  if (!vessels.empty()) {
    const cv::Mat_<std::uint8_t> inside((vessels > 0) & fundus.known);
    fundus.calibre_px = calibreOfMask(inside);
  }
  return fundus;
}

}  // namespace eyeslam::simulation
