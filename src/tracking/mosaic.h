// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/masked_contrast.h"
#include "eyeslam/tracking/tile_grid.h"

namespace eyeslam::tracking {

struct MosaicOptions {
  int row_period = 8;
  int settled_row_period = 16;
  int settled_frame = 60;
  int most_samples = 64;
  double outlier_sigmas = 4.0;
  double outlier_contrast = 0.024;
  double least_gradient = 0.006;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("row_period", self.row_period, Range{1, 64}, "frames",
                  "each row takes a sample once in so many frames; source: tracker study 2.13");
    visitor.field("settled_row_period", self.settled_row_period, Range{1, 64}, "frames",
                  "the same from settled_frame on; source: tracker study 2.13");
    visitor.field("settled_frame", self.settled_frame, Range{0, 100000}, "frames",
                  "where the period changes; source: tracker study 2.13");
    visitor.field("most_samples", self.most_samples, Range{1, 255}, "samples",
                  "length of the running mean; source: tracker study 2.13");
    visitor.field(
        "outlier_sigmas", self.outlier_sigmas, Range{1.0, 100.0}, "robust sigmas",
        "a sample farther off speaks against the pixel; source: tracker study 2.13 (a burn is accepted later)");
    visitor.field("outlier_contrast", self.outlier_contrast, Range{0.0, 1.0}, "of the background",
                  "and at least so far; source: tracker study 2.13");
    visitor.field("least_gradient", self.least_gradient, Range{0.0, 1.0}, "contrast per px",
                  "flatter blocks give no template pixel; source: tracker study 2.9 (0.003 to 0.012 alike)");
  }
};

/// The retina seen so far: a running mean of the frames' contrast, one pixel a frame pixel, in tiles that grow in all
/// four directions (tracker study, 2.13). Its pixel (i, j) lies where frame 0 has its pixel (i, j).
class Mosaic {
 public:
  static constexpr int kTile = 64;                         ///< px
  static constexpr int kBlockWidth = 8, kBlockHeight = 4;  ///< px; a block gives at most one template pixel
  static constexpr int kBlocksAcross = kTile / kBlockWidth, kBlocksDown = kTile / kBlockHeight;
  /// Pixels farther from frame 0 are ignored: a pose gone mad must not fill the memory.
  static constexpr int kReach = 1 << 15;

  /// The pixel of strongest gradient in a block: what the refinement compares.
  struct TemplatePixel {
    float x = 0.0F, y = 0.0F;    ///< mosaic px
    float value = 0.0F;          ///< contrast units
    float gx = 0.0F, gy = 0.0F;  ///< contrast units per px
    bool valid = false;
  };

  struct Tile {
    std::array<float, kTile * kTile> mean{};          ///< contrast units
    std::array<std::uint8_t, kTile * kTile> count{};  ///< samples; 0 = never seen
    std::array<TemplatePixel, kBlocksAcross * kBlocksDown> pixels{};
    std::uint32_t version = 0;  ///< grows when a pixel changed
  };

  explicit Mosaic(const MosaicOptions& options = {});

  void clear();
  bool empty() const { return tiles_.empty(); }
  /// Forgets everything and starts with a frame's picture, every row of it.
  void start(const MaskedContrast& frame);
  /// Blends the rows whose turn it is.
  /// @param map_T_frame  pose, frame px
  /// @param sigma        robust deviation of frame from mosaic, contrast units
  /// @param number       of the frame, chooses the rows
  void blend(const MaskedContrast& frame, const retina::Pose2& map_T_frame, double sigma, std::int64_t number);

  /// Image centre of frame 0, mosaic px: pixel (i, j) has centred map px (i, j) - centre().
  const Eigen::Vector2d& centre() const { return centre_; }
  const TileGrid<Tile>& tiles() const { return tiles_; }
  /// Samples of one pixel (mosaic px), 0 where never seen.
  int count(int x, int y) const;
  /// Bounding box of all tiles, mosaic px.
  cv::Rect bounds() const;
  /// Copies a region (mosaic px): mean contrast, rounded, and number of samples; 0 where never seen.
  void read(const cv::Rect& region, cv::Mat_<std::int16_t>& mean, cv::Mat_<std::uint8_t>& count) const;

 private:
  void blendRow(const MaskedContrast& frame, const retina::Pose2& frame_T_map, int row, float limit);
  void chooseTemplate(const cv::Rect& box, int period, int phase);
  void chooseInBlockRow(Tile& tile, int tx, int ty, int block_row);
  void gatherStrip(int tx, int ty, int block_row);

  MosaicOptions options_;
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  TileGrid<Tile> tiles_;
  // A block row with one pixel more on each side, for the gradients.
  static constexpr int kStripWidth = kTile + 2, kStripHeight = kBlockHeight + 2;
  std::array<float, kStripWidth * kStripHeight> strip_{};
  std::array<std::uint8_t, kStripWidth * kStripHeight> strip_count_{};
};

/// The axis-aligned box (mosaic px, whole) around a frame's view.
cv::Rect viewBox(const cv::Size& frame, const retina::Pose2& map_T_frame, const Eigen::Vector2d& mosaic_centre);

}  // namespace eyeslam::tracking
