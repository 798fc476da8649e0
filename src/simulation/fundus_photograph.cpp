// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/fundus_photograph.h"

#include <algorithm>
#include <array>
#include <cmath>
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

// Every pixel of the disc around (x, y) that is in a vessel has at least its calibre.
void inscribeDisc(const cv::Mat_<std::uint8_t>& vessels, cv::Point centre, float radius, cv::Mat_<float>& calibre)
{
  const int reach = static_cast<int>(radius);
  // A line one pixel wide has distance 1 at its centre: half a pixel belongs to either side.
  const float width = 2.0F * radius - 1.0F;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      if (static_cast<float>(dx * dx + dy * dy) > radius * radius) continue;
      const cv::Point place = centre + cv::Point(dx, dy);
      if (!place.inside({{0, 0}, vessels.size()}) || !vessels(place)) continue;
      calibre(place) = std::max(calibre(place), width);
    }
  }
}

// Discs beside the centreline lie within a neighbour's: a step of one pixel gains one pixel of distance there.
bool mayBeCentre(const cv::Mat_<float>& distance, int x, int y)
{
  constexpr float kSlope = 0.93F;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const cv::Point place(x + dx, y + dy);
      if ((dx == 0 && dy == 0) || !place.inside({{0, 0}, distance.size()})) continue;
      if (distance(place) - distance(y, x) > kSlope * static_cast<float>(std::hypot(dx, dy))) return false;
    }
  }
  return true;
}

}  // namespace

cv::Mat_<float> calibreOfMask(const cv::Mat_<std::uint8_t>& vessels)
{
  cv::Mat_<float> calibre(vessels.size(), 0.0F);
  cv::Mat_<float> distance;
  cv::distanceTransform(vessels, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  for (int y = 0; y < vessels.rows; ++y) {
    for (int x = 0; x < vessels.cols; ++x) {
      if (vessels(y, x) && mayBeCentre(distance, x, y)) inscribeDisc(vessels, {x, y}, distance(y, x), calibre);
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
