// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::tracking {

/// The pose as a 2 x 3 matrix from px of an image of that size to map px, both full px (contracts, section 1).
cv::Matx23d mapFromImage(const retina::Pose2& map_T_frame, cv::Size size);

/// The inverse of a similarity or affinity given as a 2 x 3 matrix.
cv::Matx23d inverse(const cv::Matx23d& affinity);

/// First `inner`, then `outer`.
cv::Matx23d chain(const cv::Matx23d& outer, const cv::Matx23d& inner);

cv::Point2d transformed(const cv::Matx23d& affinity, cv::Point2d point);

/// The corners of the view in the map, clockwise from the image's top left; full px.
std::array<cv::Point2d, 4> viewOutline(const retina::Pose2& map_T_frame, cv::Size size);

/// The map's vessel cells (128 and more) that the view holds, in px of the image; at most about `most` of them, spread
/// evenly over rows and columns.
std::vector<cv::Point2d> vesselsInView(const retina::VesselMap& map, const retina::Pose2& map_T_frame, cv::Size size,
                                       std::size_t most);

}  // namespace eyeslam::tracking
