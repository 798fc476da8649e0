// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace eyeslam::tracking {

/// A stack of float pictures with a margin of zeros one pixel wide, so that a 3x3 kernel needs no case for the edge.
class Planes {
 public:
  Planes(int channels, int width, int height);

  int channels() const { return channels_; }
  int width() const { return width_; }
  int height() const { return height_; }
  int stride() const { return width_ + 2; }
  /// First pixel of a row, without the margin; row -1 and `height` are the margin's.
  float* row(int channel, int y) { return values_.data() + index(channel, y); }
  const float* row(int channel, int y) const { return values_.data() + index(channel, y); }

 private:
  std::size_t index(int channel, int y) const
  {
    return (static_cast<std::size_t>(channel) * static_cast<std::size_t>(height_ + 2) +
            static_cast<std::size_t>(y + 1)) *
               static_cast<std::size_t>(stride()) +
           1;
  }

  int channels_, width_, height_;
  std::vector<float> values_;
};

/// A small convolution net that tells vessels from everything else on the mosaic: three resolutions (2, 4 and 8 px),
/// two layers down, three at the bottom, two up on each side, joined by sums. About 3900 multiplications a pixel.
/// It works layer by layer, so that a caller may stop after any of them and go on in the next frame.
/// Weights: vessel_net_weights.cpp, made by scripts/train_vessel_net.
class VesselNet {
 public:
  /// Side of the square region that is worked on at once, px; fixed, so that nothing is allocated later.
  static constexpr int kRegion = 192;
  /// Contrast units (Frame::kContrastUnit) that count as 1 in the net, and where its input is cut off.
  static constexpr float kInputUnit = 256.0F, kInputLimit = 8.0F;

  VesselNet();

  /// Takes a region, kRegion x kRegion: contrast of the mosaic and number of samples. A pixel
  /// whose samples were outvoted has none for a while but keeps its contrast: it counts as seen.
  void begin(const cv::Mat_<std::int16_t>& contrast, const cv::Mat_<std::uint8_t>& count);
  /// Works one layer. @return its cost in multiplications; 0 when all are done
  std::size_t step();
  bool done() const { return next_ == kLayers; }

  /// Log odds of a vessel at a pixel of the region, once `done`.
  float logOdds(int x, int y) const { return output_.row(phase(x, y), y / 2)[x / 2]; }
  /// Vessel width at that pixel, region px.
  float calibre(int x, int y) const { return kCalibreUnit * output_.row(4 + phase(x, y), y / 2)[x / 2]; }

 private:
  static constexpr int kLayers = 12;
  static constexpr float kCalibreUnit = 4.0F;

  struct Layer {
    int inputs = 0, outputs = 0;
    std::vector<float> weights, bias;
  };

  static int phase(int x, int y) { return 2 * (y % 2) + x % 2; }
  std::size_t convolve(const Planes& in, Planes& out);
  // A 1x1 layer from the coarser resolution, added to what the finer one had on the way down.
  void join(int which, const Planes& coarse, const Planes& fine, Planes& sum);

  std::vector<Layer> layers_;  // 3x3 in the order in which they run, then the joins
  Planes input_;
  Planes fine1_, fine2_, fine_sum_;  // px pairs
  Planes middle_in_, middle1_, middle2_, middle_sum_;
  Planes coarse_in_, coarse1_, coarse2_;
  Planes output_;
  std::array<float, kRegion / 2> mixed_{};
  int next_ = kLayers;
};

}  // namespace eyeslam::tracking
