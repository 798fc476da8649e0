// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/mosaic.h"
#include "eyeslam/tracking/occlusion_mask.h"
#include "eyeslam/tracking/tile_grid.h"

namespace eyeslam::tracking {

/// The mosaic as a picture for people. The mosaic itself holds contrast only; the colour of the retina changes slowly
/// from place to place, so its running mean over cells of 4 px is enough, and the contrast is laid over it.
class MosaicPicture {
 public:
  void clear() { tiles_.clear(); }
  /// Takes the colours of a frame. @param mosaic_T_frame  frame px
  void observe(const Frame& frame, const OcclusionMask& mask, const Eigen::Vector2d& mosaic_centre,
               const retina::Pose2& mosaic_T_frame);
  /// Draws the smallest rectangle that holds all that was seen: BGR, 8 bit, a pixel a mosaic pixel, black where never
  /// seen. Takes some 10 ms a megapixel.
  /// @param corner  set to the mosaic px of the picture's pixel (0, 0)
  cv::Mat draw(const Mosaic& mosaic, cv::Point& corner) const;

 private:
  static constexpr int kTile = Mosaic::kTile / Frame::kCell;  // cells
  struct Tile {
    std::array<cv::Vec3f, kTile * kTile> colour{};  // BGR, 0 to 255
    std::array<std::uint16_t, kTile * kTile> count{};
  };
  cv::Mat_<cv::Vec3f> smoothColours(const cv::Rect& cells) const;

  TileGrid<Tile> tiles_;
};

}  // namespace eyeslam::tracking
