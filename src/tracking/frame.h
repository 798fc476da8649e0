// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::tracking {

class OcclusionMask;

struct FrameOptions {
  double scale = 0.5;
  int least_rows = 96;
  double white_level = 0.0;
  int background_radius_cells = 3;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("scale", self.scale, Range{0.1, 1.0}, "",
                  "processed px per full-resolution px; source: paper, input is resized in half");
    visitor.field("least_rows", self.least_rows, Range{32, 10000}, "px",
                  "pictures are not shrunk below so many; source: sequences shrunk to 128 x 96 are lost at 48 rows");
    visitor.field("white_level", self.white_level, Range{0.0, 65535.0}, "grey levels",
                  "brightest value of a 16-bit picture, 0 = the type's; source: the camera (12 bit: 4095)");
    visitor.field("background_radius_cells", self.background_radius_cells, Range{1, 16}, "cells of 4 px",
                  "half width of the background mean; source: tracker study 2.4 (2 alike, 5 is 7-20 % worse)");
  }
};

/// One image made ready once for all steps: scaled, split, averaged over cells, and freed of its background.
/// Memory is taken with the first image and reused; later images must have its size and type.
class Frame {
 public:
  /// Cells are squares of this many frame px; the last row and column may reach over the picture's end.
  static constexpr int kCell = 4;
  /// `contrast()` of a pixel as bright as twice its background.
  static constexpr int kContrastUnit = 4096;
  /// A cell whose red is no brighter lies outside the lit field and says nothing about the light; source: tracker study
  /// 2.2.
  static constexpr int kBlack = 25;

  explicit Frame(const FrameOptions& options = {});

  /// Takes an image, 8 or 16 bit, one (grey) or three channels (BGR); keeps no reference.
  /// @return none, or wrong_size when empty, of another type, under 32 processed px, or not like the first one
  retina::Reason assign(const cv::Mat& image);

  /// Fills `contrast()`: the background is the masked mean around each cell (tracker study, 2.4).
  void normalise(const OcclusionMask& mask);

  bool isGrey() const { return channels_ == 1; }
  int width() const { return green_.cols; }
  int height() const { return green_.rows; }
  /// Image centre, frame px.
  Eigen::Vector2d centre() const { return {(width() - 1) / 2.0, (height() - 1) / 2.0}; }
  /// Full px per frame px, in x and y.
  Eigen::Vector2d pixelSize() const { return pixel_size_; }
  /// Where the centre of the frame lies in the image as it came, full px.
  Eigen::Vector2d centreInImage() const;
  /// The grey level of white in the image as it came.
  double white() const { return 255.0 / to_eight_bits_; }
  /// Size of the image as it came, full px.
  cv::Size fullSize() const { return full_size_; }

  /// Green (or grey), ten bits (0 to 1020), `height` x `width`.
  const cv::Mat_<std::uint16_t>& green() const { return green_; }
  /// Means over cells: green 0 to 1020, red and blue (sampled) 0 to 255. Of a grey image, red = blue = grey.
  const cv::Mat_<std::uint16_t>& cellGreen() const { return cell_green_; }
  const cv::Mat_<std::uint8_t>& cellRed() const { return cell_red_; }
  const cv::Mat_<std::uint8_t>& cellBlue() const { return cell_blue_; }
  /// (g / background - 1) x kContrastUnit, smoothed by [1 2 1] both ways, `height` x `width`; vessels are negative.
  const cv::Mat_<std::int16_t>& contrast() const { return contrast_; }

 private:
  void allocate(const cv::Mat& image);
  void shrink(const cv::Mat& image);
  void averageCells();
  void sampleColours(const cv::Mat& image);
  void estimateBackground(const OcclusionMask& mask);

  FrameOptions options_;
  double scale_ = 0.5;  // the option's, or what keeps the picture large enough
  int type_ = -1;
  int channels_ = 0;
  double to_ten_bits_ = 1.0;    // times a grey level of the image: 0 to 1020
  double to_eight_bits_ = 1.0;  // times a grey level of the image: 0 to 255
  cv::Size full_size_;
  Eigen::Vector2d pixel_size_ = {1.0, 1.0};
  cv::Mat_<std::uint16_t> green_, cell_green_;
  cv::Mat_<std::uint8_t> cell_red_, cell_blue_;
  cv::Mat_<std::int16_t> contrast_;
  cv::Mat_<float> weight_, weighted_, inverse_background_, box_;
  std::vector<float> row_gain_;
  std::vector<int> sample_at_;      // two elements of an image row for each cell
  std::vector<std::int16_t> rows_;  // three rows of unsmoothed contrast
  cv::Mat channel_, wide_;          // for scales other than one half
};

}  // namespace eyeslam::tracking
