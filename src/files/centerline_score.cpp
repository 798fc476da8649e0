// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/centerline_score.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "eyeslam/files/distance_picture.h"
#include "eyeslam/files/thinning.h"
#include "eyeslam/tracking/sub_pixel.h"

namespace eyeslam::files {
namespace {

constexpr double kCoveredWithin_px = 4.0;  // as for maps (MapScorer)

class Ruler {
 public:
  Ruler(const KnownVessels& known, double tolerance_px)
      : geometry_(known.geometry), tolerance_(static_cast<float>(tolerance_px / known.geometry.px_per_cell))
  {
    if (cv::countNonZero(known.vessels) == 0) throw std::invalid_argument("there is no known vessel to compare with");
    if (!known.covered.empty() && known.covered.size() != known.vessels.size()) {
      throw std::invalid_argument("the covered part and the known vessels differ in size");
    }
    lines_ = thinned(known.vessels);
    to_line_ = distanceTo(lines_);
    cv::distanceTransform(known.vessels != 0, to_wall_, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    if (known.covered.empty()) return;
    const double within = kCoveredWithin_px / geometry_.px_per_cell;
    lines_.setTo(0, distanceTo(known.covered) > within);
  }

  cv::Point2d place(const fixtures::CenterlinePoint& point) const
  {
    return {(point.position_px.x() - geometry_.origin_x) / geometry_.px_per_cell,
            (point.position_px.y() - geometry_.origin_y) / geometry_.px_per_cell};
  }

  double recall(const std::vector<fixtures::Vessel>& vessels) const
  {
    cv::Mat_<std::uint8_t> drawn(lines_.size(), std::uint8_t{0});
    const auto fixed = [this](const fixtures::CenterlinePoint& point) { return tracking::inSubPixels(place(point)); };
    for (const fixtures::Vessel& vessel : vessels) {
      for (std::size_t i = 1; i < vessel.points.size(); ++i) {
        cv::line(drawn, fixed(vessel.points[i - 1]), fixed(vessel.points[i]), 255, 1, cv::LINE_8,
                 tracking::kSubPixelBits);
      }
    }
    const cv::Mat near = distanceTo(drawn) <= tolerance_;
    const int wanted = cv::countNonZero(lines_);
    return wanted == 0 ? 0.0 : static_cast<double>(cv::countNonZero(near & lines_)) / wanted;
  }

  /// Nearest px of the picture to a point, if it lies inside.
  std::optional<cv::Point> pixelOf(const fixtures::CenterlinePoint& point) const
  {
    const cv::Point at(place(point));
    if (!cv::Rect({}, lines_.size()).contains(at)) return std::nullopt;
    return at;
  }

  bool onLine(cv::Point at) const { return to_line_(at) <= tolerance_; }
  /// Half of a px before the first one that is none.
  double radius(cv::Point at) const { return (to_wall_(at) - 0.5) * geometry_.px_per_cell; }

 private:
  PictureGeometry geometry_;
  float tolerance_;
  cv::Mat_<std::uint8_t> lines_;
  cv::Mat_<float> to_line_, to_wall_;
};

double median(std::vector<double> values)
{
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

CenterlineScore scoreCenterlines(const std::vector<fixtures::Vessel>& vessels, const KnownVessels& known,
                                 double tolerance_px)
{
  const Ruler ruler(known, tolerance_px);
  CenterlineScore score;
  score.recall = ruler.recall(vessels);
  std::vector<double> radius_errors;
  std::size_t points = 0, right = 0;
  for (const fixtures::Vessel& vessel : vessels) {
    score.centerlines_px += vessel.length_px();
    score.longest_vessel_px = std::max(score.longest_vessel_px, vessel.length_px());
    for (const fixtures::CenterlinePoint& point : vessel.points) {
      ++points;
      const auto at = ruler.pixelOf(point);
      if (!at || !ruler.onLine(*at)) continue;
      ++right;
      if (ruler.radius(*at) > 0.0) radius_errors.push_back(std::abs(point.radius_px - ruler.radius(*at)));
    }
  }
  score.precision = points == 0 ? 0.0 : static_cast<double>(right) / static_cast<double>(points);
  score.radius_error_px = median(radius_errors);
  return score;
}

}  // namespace eyeslam::files
