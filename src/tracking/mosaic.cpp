// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/mosaic.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "eyeslam/retina/vector_kernel.h"
#include "eyeslam/tracking/cubic_sampler.h"

namespace eyeslam::tracking {

namespace {

// The part of [from, to] in which start + i step lies in [lowest, highest].
void clip(double start, double step, double lowest, double highest, double& from, double& to)
{
  if (std::abs(step) < 1e-12) {
    if (start < lowest || start > highest) to = from - 1.0;
    return;
  }
  const double a = (lowest - start) / step;
  const double b = (highest - start) / step;
  from = std::max(from, std::min(a, b));
  to = std::min(to, std::max(a, b));
}

// Rounds without a library call, which would keep the loop from vector units.
EYESLAM_VECTOR_KERNEL void roundRow(const float* values, int count, std::int16_t* rounded)
{
  constexpr int kShift = 1 << 15;  // makes every value positive, where truncation rounds down
  for (int i = 0; i < count; ++i) {
    rounded[i] = static_cast<std::int16_t>(static_cast<int>(values[i] + (kShift + 0.5F)) - kShift);
  }
}

// Squared gradients of one row of the strip by 3x3 smoothed central differences; 0 next to a pixel never seen.
EYESLAM_VECTOR_KERNEL void gradientRow(const float* above, const float* middle, const float* below,
                                       const std::uint8_t* counts, int stride, float* gx, float* gy, float* strength)
{
  constexpr int kTile = Mosaic::kTile;
  constexpr float kEighth = 0.125F;
  for (int i = 0; i < kTile; ++i) {
    const float dx = (above[i + 2] - above[i]) + 2.0F * (middle[i + 2] - middle[i]) + (below[i + 2] - below[i]);
    const float dy = (below[i] - above[i]) + 2.0F * (below[i + 1] - above[i + 1]) + (below[i + 2] - above[i + 2]);
    gx[i] = kEighth * dx;
    gy[i] = kEighth * dy;
  }
  std::uint8_t least[kTile + 2];
  for (int i = 0; i < kTile + 2; ++i) least[i] = std::min({counts[i], counts[i + stride], counts[i + 2 * stride]});
  for (int i = 0; i < kTile; ++i) {
    const std::uint8_t known = std::min({least[i], least[i + 1], least[i + 2]});
    strength[i] = known > 0 ? gx[i] * gx[i] + gy[i] * gy[i] : 0.0F;
  }
}

}  // namespace

cv::Rect viewBox(const cv::Size& frame, const retina::Pose2& map_T_frame, const Eigen::Vector2d& mosaic_centre)
{
  const Eigen::Matrix2d linear = map_T_frame.linear();
  const Eigen::Vector2d half = linear.cwiseAbs() * Eigen::Vector2d((frame.width - 1) / 2.0, (frame.height - 1) / 2.0);
  const Eigen::Vector2d middle = mosaic_centre + map_T_frame.translation();
  const auto bound = [](double v) {
    constexpr double kReach = Mosaic::kReach;
    return static_cast<int>(std::floor(std::clamp(v, -kReach, kReach)));
  };
  const cv::Point from(bound(middle.x() - half.x()), bound(middle.y() - half.y()));
  const cv::Point to(bound(middle.x() + half.x()) + 1, bound(middle.y() + half.y()) + 1);
  return {from, to + cv::Point(1, 1)};
}

Mosaic::Mosaic(const MosaicOptions& options) : options_(options) {}

void Mosaic::clear() { tiles_.clear(); }

void Mosaic::start(const MaskedContrast& frame)
{
  clear();
  centre_ = frame.centre();
  const cv::Rect box = viewBox(frame.size(), {}, centre_);
  for (int row = box.y; row < box.br().y; ++row) blendRow(frame, {}, row, 0.0F);
  chooseTemplate(box, 1, 0);
}

void Mosaic::blend(const MaskedContrast& frame, const retina::Pose2& map_T_frame, double sigma, std::int64_t number)
{
  const int period = number < options_.settled_frame ? options_.row_period : options_.settled_row_period;
  const int phase = static_cast<int>(number % period);
  const double limit = std::max(options_.outlier_sigmas * sigma, options_.outlier_contrast * Frame::kContrastUnit);
  const cv::Rect box = viewBox(frame.size(), map_T_frame, centre_);
  const retina::Pose2 frame_T_map = map_T_frame.inverse();
  for (int row = box.y; row < box.br().y; ++row) {
    if (row - floorDivide(row, period) * period == phase) {
      blendRow(frame, frame_T_map, row, static_cast<float>(limit));
    }
  }
  chooseTemplate(box, period, phase);
}

void Mosaic::blendRow(const MaskedContrast& frame, const retina::Pose2& frame_T_map, int row, float limit)
{
  // Along a mosaic row the position in the frame moves by a constant step.
  const Eigen::Matrix2d linear = frame_T_map.linear();
  const Eigen::Vector2d start = frame_T_map * Eigen::Vector2d(-centre_.x(), row - centre_.y()) + frame.centre();
  const Eigen::Vector2d step = linear.col(0);
  double from = -kReach, to = kReach;
  constexpr double kMargin = CubicSampler::kMargin;
  clip(start.x(), step.x(), kMargin, frame.width() - 1 - kMargin, from, to);
  clip(start.y(), step.y(), kMargin, frame.height() - 1 - kMargin, from, to);

  const CubicSampler sample(frame.contrast);
  Tile* tile = nullptr;
  int tile_x = 0;
  const int ty = floorDivide(row, kTile);
  const auto most = static_cast<std::uint8_t>(options_.most_samples);
  for (int i = static_cast<int>(std::ceil(from)); i <= static_cast<int>(std::floor(to)); ++i) {
    const auto x = static_cast<float>(start.x() + i * step.x());
    const auto y = static_cast<float>(start.y() + i * step.y());
    if (!frame.isVisible(static_cast<int>(x + 0.5F), static_cast<int>(y + 0.5F))) continue;
    const int tx = floorDivide(i, kTile);
    if (!tile || tx != tile_x) {
      tile = &tiles_.at(tx, ty);
      tile_x = tx;
      ++tile->version;
    }
    const auto at = static_cast<std::size_t>((row - ty * kTile) * kTile + i - tx * kTile);
    const float value = sample(x, y);
    const float difference = value - tile->mean[at];
    std::uint8_t& count = tile->count[at];
    if (count > 0 && limit > 0.0F && std::abs(difference) > limit) {
      --count;  // what stays different is accepted once it has outvoted what was there
      continue;
    }
    if (count < most) ++count;
    tile->mean[at] += difference / static_cast<float>(count);
  }
}

void Mosaic::chooseTemplate(const cv::Rect& box, int period, int phase)
{
  for (int block = floorDivide(box.y, kBlockHeight); block <= floorDivide(box.br().y - 1, kBlockHeight); ++block) {
    // Only blocks that took a row; once the mosaic has settled, only when their last row had its turn: the four rows
    // of a block are blended in four frames running, and little changes from one to the next.
    const int first = block * kBlockHeight;
    const int offset = phase - (first - floorDivide(first, period) * period);
    const int earliest = period >= options_.settled_row_period ? kBlockHeight - 1 : 0;
    const bool due = period <= kBlockHeight || (offset >= earliest && offset < kBlockHeight);
    if (!due) continue;
    const int ty = floorDivide(first, kTile);
    for (int tx = floorDivide(box.x, kTile); tx <= floorDivide(box.br().x - 1, kTile); ++tx) {
      if (Tile* tile = tiles_.find(tx, ty)) chooseInBlockRow(*tile, tx, ty, (first - ty * kTile) / kBlockHeight);
    }
  }
}

void Mosaic::gatherStrip(int tx, int ty, int block_row)
{
  for (int r = 0; r < kStripHeight; ++r) {
    const int row = block_row * kBlockHeight + r - 1;
    const int from_ty = row < 0 ? ty - 1 : (row >= kTile ? ty + 1 : ty);
    const int y = (row + kTile) % kTile;
    float* values = strip_.data() + r * kStripWidth;
    std::uint8_t* counts = strip_count_.data() + r * kStripWidth;
    const auto at = static_cast<std::size_t>(y * kTile);
    const Tile* left = tiles_.find(tx - 1, from_ty);
    const Tile* here = tiles_.find(tx, from_ty);
    const Tile* right = tiles_.find(tx + 1, from_ty);
    values[0] = left ? left->mean[at + kTile - 1] : 0.0F;
    counts[0] = left ? left->count[at + kTile - 1] : std::uint8_t{0};
    values[kTile + 1] = right ? right->mean[at] : 0.0F;
    counts[kTile + 1] = right ? right->count[at] : std::uint8_t{0};
    if (here) {
      std::memcpy(values + 1, here->mean.data() + at, kTile * sizeof(float));
      std::memcpy(counts + 1, here->count.data() + at, kTile);
    } else {
      std::fill_n(values + 1, kTile, 0.0F);
      std::fill_n(counts + 1, kTile, std::uint8_t{0});
    }
  }
}

void Mosaic::chooseInBlockRow(Tile& tile, int tx, int ty, int block_row)
{
  gatherStrip(tx, ty, block_row);
  std::array<float, kTile> gx, gy, strength;
  std::array<TemplatePixel, kBlocksAcross> best{};
  std::array<float, kBlocksAcross> most;
  most.fill(static_cast<float>(options_.least_gradient * options_.least_gradient) * Frame::kContrastUnit *
            Frame::kContrastUnit);
  for (int r = 1; r <= kBlockHeight; ++r) {
    const float* middle = strip_.data() + r * kStripWidth;
    gradientRow(middle - kStripWidth, middle, middle + kStripWidth, strip_count_.data() + (r - 1) * kStripWidth,
                kStripWidth, gx.data(), gy.data(), strength.data());
    for (std::size_t i = 0; i < kTile; ++i) {
      const std::size_t block = i / kBlockWidth;
      if (strength[i] <= most[block]) continue;
      most[block] = strength[i];
      best[block] = {static_cast<float>(tx * kTile + static_cast<int>(i)),
                     static_cast<float>(ty * kTile + block_row * kBlockHeight + r - 1),
                     middle[i + 1],
                     gx[i],
                     gy[i],
                     true};
    }
  }
  std::copy(best.begin(), best.end(), tile.pixels.begin() + block_row * kBlocksAcross);
}

int Mosaic::count(int x, int y) const
{
  const int tx = floorDivide(x, kTile), ty = floorDivide(y, kTile);
  const Tile* tile = tiles_.find(tx, ty);
  return tile ? tile->count[static_cast<std::size_t>((y - ty * kTile) * kTile + x - tx * kTile)] : 0;
}

cv::Rect Mosaic::bounds() const
{
  return {cv::Point(tiles_.firstX() * kTile, tiles_.firstY() * kTile),
          cv::Point(tiles_.endX() * kTile, tiles_.endY() * kTile)};
}

void Mosaic::read(const cv::Rect& region, cv::Mat_<std::int16_t>& mean, cv::Mat_<std::uint8_t>& count) const
{
  mean.create(region.height, region.width);
  count.create(region.height, region.width);
  for (int y = 0; y < region.height; ++y) {  // setTo would allocate
    std::fill_n(mean[y], region.width, std::int16_t{0});
    std::fill_n(count[y], region.width, std::uint8_t{0});
  }
  for (int ty = floorDivide(region.y, kTile); ty <= floorDivide(region.br().y - 1, kTile); ++ty) {
    for (int tx = floorDivide(region.x, kTile); tx <= floorDivide(region.br().x - 1, kTile); ++tx) {
      const Tile* tile = tiles_.find(tx, ty);
      if (!tile) continue;
      const cv::Rect part = region & cv::Rect(tx * kTile, ty * kTile, kTile, kTile);
      for (int y = part.y; y < part.br().y; ++y) {
        const auto at = static_cast<std::size_t>((y - ty * kTile) * kTile + part.x - tx * kTile);
        roundRow(tile->mean.data() + at, part.width, mean[y - region.y] + part.x - region.x);
        std::copy_n(tile->count.data() + at, part.width, count[y - region.y] + part.x - region.x);
      }
    }
  }
}

}  // namespace eyeslam::tracking
