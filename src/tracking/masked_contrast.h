// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/occlusion_mask.h"

namespace eyeslam::tracking {

/// What alignment needs of a frame: its contrast and what is hidden. Refers to planes that somebody else keeps: those
/// of the current frame, or of frame 0.
struct MaskedContrast {
  const cv::Mat_<std::int16_t>& contrast;  ///< Frame::contrast()
  const cv::Mat_<std::uint8_t>& hidden;    ///< OcclusionMask::cells()

  MaskedContrast(const cv::Mat_<std::int16_t>& contrast_plane, const cv::Mat_<std::uint8_t>& hidden_cells)
      : contrast(contrast_plane), hidden(hidden_cells)
  {}
  MaskedContrast(const Frame& frame, const OcclusionMask& mask) : MaskedContrast(frame.contrast(), mask.cells()) {}

  int width() const { return contrast.cols; }
  int height() const { return contrast.rows; }
  cv::Size size() const { return contrast.size(); }
  /// Image centre, frame px.
  Eigen::Vector2d centre() const { return {(width() - 1) / 2.0, (height() - 1) / 2.0}; }
  /// Whether a frame pixel shows retina; (x, y) must lie in the frame.
  bool isVisible(int x, int y) const { return hidden(y / Frame::kCell, x / Frame::kCell) == OcclusionMask::kVisible; }
};

/// Root mean square gradient of the visible contrast on a sparse grid, contrast units per px: how sharp a frame is.
double sharpness(const MaskedContrast& picture);

}  // namespace eyeslam::tracking
