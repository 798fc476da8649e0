// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/view_geometry.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace eyeslam::tracking {

cv::Matx23d mapFromImage(const retina::Pose2& map_T_frame, cv::Size size)
{
  const Eigen::Vector2d centre((size.width - 1) / 2.0, (size.height - 1) / 2.0);
  const Eigen::Matrix2d linear = map_T_frame.linear();
  const Eigen::Vector2d shift = centre + map_T_frame.translation() - linear * centre;
  return {linear(0, 0), linear(0, 1), shift.x(), linear(1, 0), linear(1, 1), shift.y()};
}

cv::Matx23d inverse(const cv::Matx23d& affinity)
{
  cv::Matx23d result;
  cv::invertAffineTransform(affinity, result);
  return result;
}

cv::Matx23d chain(const cv::Matx23d& outer, const cv::Matx23d& inner)
{
  const cv::Matx33d whole(inner(0, 0), inner(0, 1), inner(0, 2), inner(1, 0), inner(1, 1), inner(1, 2), 0.0, 0.0, 1.0);
  return outer * whole;
}

cv::Point2d transformed(const cv::Matx23d& a, cv::Point2d p)
{
  return {a(0, 0) * p.x + a(0, 1) * p.y + a(0, 2), a(1, 0) * p.x + a(1, 1) * p.y + a(1, 2)};
}

std::array<cv::Point2d, 4> viewOutline(const retina::Pose2& map_T_frame, cv::Size size)
{
  const cv::Matx23d map_T_image = mapFromImage(map_T_frame, size);
  const double right = size.width - 0.5, bottom = size.height - 0.5;
  return {transformed(map_T_image, {-0.5, -0.5}), transformed(map_T_image, {right, -0.5}),
          transformed(map_T_image, {right, bottom}), transformed(map_T_image, {-0.5, bottom})};
}

std::vector<cv::Point2d> vesselsInView(const retina::VesselMap& map, const retina::Pose2& map_T_frame, cv::Size size,
                                       std::size_t most)
{
  const cv::Matx23d cells(map.px_per_cell, 0.0, map.origin_x, 0.0, map.px_per_cell, map.origin_y);
  const cv::Matx23d image_T_cell = chain(inverse(mapFromImage(map_T_frame, size)), cells);
  const cv::Rect2d image(0.0, 0.0, size.width - 1.0, size.height - 1.0);
  std::vector<cv::Point2d> found;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.probability[map.index(column, row)] < 128) continue;
      const cv::Point2d at = transformed(image_T_cell, {static_cast<double>(column), static_cast<double>(row)});
      if (image.contains(at)) found.push_back(at);
    }
  }
  if (found.size() <= most) return found;
  // Every n-th along the rows; n shares no factor with the rows' rhythm often enough to look even.
  std::vector<cv::Point2d> thinned;
  const double every = static_cast<double>(found.size()) / static_cast<double>(most);
  for (double i = 0.0; i < static_cast<double>(found.size()); i += every) {
    thinned.push_back(found[static_cast<std::size_t>(i)]);
  }
  return thinned;
}

}  // namespace eyeslam::tracking
