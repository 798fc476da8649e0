// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "eyeslam/files/map_files.h"
#include "eyeslam/fixtures/vessel.h"

namespace eyeslam::files {

/// How well centrelines follow known vessels. Shares in [0, 1], lengths in full-resolution px.
struct CenterlineScore {
  double recall = 0.0;             ///< share of the vessels' own thinned lines with a centreline within the tolerance
  double precision = 0.0;          ///< share of the centrelines with such a thinned line within the tolerance
  double radius_error_px = 0.0;    ///< median, against the distance to the vessel's wall
  double centerlines_px = 0.0;     ///< length of all centrelines
  double longest_vessel_px = 0.0;  ///< of one piece between junctions or ends
};

/// Vessels that are known, as a picture.
struct KnownVessels {
  cv::Mat_<std::uint8_t> vessels;  ///< non-zero = vessel
  PictureGeometry geometry;        ///< where the picture lies in the map frame
  /// Only vessels near one of these px count for the recall; empty: all do. Of the same size.
  cv::Mat_<std::uint8_t> covered;
};

/// Judges centrelines against known vessels. The yardstick is thinned by other code than the graph's (Zhang and Suen).
/// Costs distance transforms of the whole picture: for reports.
/// @param tolerance_px  full-resolution px
/// @throws std::invalid_argument when the pictures differ in size, or there is no known vessel
CenterlineScore scoreCenterlines(const std::vector<fixtures::Vessel>& vessels, const KnownVessels& known,
                                 double tolerance_px);

}  // namespace eyeslam::files
