// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/frame.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "eyeslam/tracking/frame_kernels.h"
#include "eyeslam/tracking/occlusion_mask.h"

namespace eyeslam::tracking {

namespace {

constexpr int kSmallestSide = 32;
constexpr double kTenBits = 1020.0;  // the sum of four eight-bit values, the scale of the usual case

bool isUsable(const cv::Mat& image)
{
  const bool depth = image.depth() == CV_8U || image.depth() == CV_16U;
  return image.dims == 2 && depth && (image.channels() == 1 || image.channels() == 3) &&
         std::min(image.cols, image.rows) >= kSmallestSide;
}

// Sums a (2 radius + 1) box around each cell; what lies outside counts as nothing. `scratch` has the same size.
void boxSum(cv::Mat_<float>& values, int radius, cv::Mat_<float>& scratch)
{
  const int rows = values.rows;
  const int columns = values.cols;
  for (int y = 0; y < rows; ++y) {
    float* sums = scratch[y];
    std::fill(sums, sums + columns, 0.0F);
    for (int v = std::max(0, y - radius); v <= std::min(rows - 1, y + radius); ++v)
      kernels::addRow(values[v], columns, sums);
  }
  for (int y = 0; y < rows; ++y) {
    float* sums = values[y];
    std::fill(sums, sums + columns, 0.0F);
    for (int d = -radius; d <= radius; ++d) {
      const int from = std::max(0, -d);
      const int count = columns - std::abs(d);
      if (count > 0) kernels::addRow(scratch[y] + from + d, count, sums + from);
    }
  }
}

// Means of two pixels a cell, at a quarter and three quarters of it: red and blue only tell retina from what is not.
template <class T>
void sampleRow(const T* upper, const T* lower, const std::vector<int>& at, int blue_to_red, float gain,
               std::uint8_t* red, std::uint8_t* blue)
{
  const std::size_t cells = at.size() / 2;
  for (std::size_t i = 0; i < cells; ++i) {
    const T* a = upper + at[2 * i];
    const T* b = lower + at[2 * i + 1];
    blue[i] = static_cast<std::uint8_t>(std::min(255.0F, gain * static_cast<float>(a[0] + b[0])));
    red[i] = static_cast<std::uint8_t>(std::min(255.0F, gain * static_cast<float>(a[blue_to_red] + b[blue_to_red])));
  }
}

}  // namespace

Frame::Frame(const FrameOptions& options) : options_(options) {}

retina::Reason Frame::assign(const cv::Mat& image)
{
  if (!isUsable(image)) return retina::Reason::wrong_size;
  if (type_ < 0) allocate(image);
  if (green_.empty() || image.type() != type_ || image.size() != full_size_) return retina::Reason::wrong_size;
  shrink(image);
  averageCells();
  sampleColours(image);
  return retina::Reason::none;
}

Eigen::Vector2d Frame::centreInImage() const { return (pixel_size_.array() * (centre().array() + 0.5) - 0.5).matrix(); }

void Frame::allocate(const cv::Mat& image)
{
  const double least = static_cast<double>(options_.least_rows) / std::min(image.cols, image.rows);
  scale_ = std::max(options_.scale, std::min(1.0, least));
  // Half drops an odd last row or column, so that two px are one exactly; other scales stretch by under a pixel.
  const auto scaled = [&](int side) { return static_cast<int>(std::floor(side * scale_ + 1e-6)); };
  const int width = scaled(image.cols);
  const int height = scaled(image.rows);
  if (std::min(width, height) < kSmallestSide) return;
  type_ = image.type();
  channels_ = image.channels();
  full_size_ = image.size();
  pixel_size_ = scale_ == 0.5 ? Eigen::Vector2d(2.0, 2.0)
                              : Eigen::Vector2d(static_cast<double>(image.cols) / width,
                                                static_cast<double>(image.rows) / height);
  double white = image.depth() == CV_8U ? 255.0 : 65535.0;
  if (image.depth() == CV_16U && options_.white_level > 0.0) white = options_.white_level;
  to_ten_bits_ = kTenBits / white;
  to_eight_bits_ = 255.0 / white;

  const int columns = (width + kCell - 1) / kCell;
  const int rows = (height + kCell - 1) / kCell;
  green_.create(height, width);
  contrast_.create(height, width);
  cell_green_.create(rows, columns);
  for (auto* cells : {&cell_red_, &cell_blue_}) cells->create(rows, columns);
  for (auto* cells : {&weight_, &weighted_, &inverse_background_, &box_}) cells->create(rows, columns);
  const auto padded = static_cast<std::size_t>(columns) * kCell;
  row_gain_.resize(2 * padded + 2);
  rows_.resize(4 * (padded + 2));
  sample_at_.resize(2 * static_cast<std::size_t>(columns));
  for (std::size_t i = 0; i < sample_at_.size(); ++i) {
    const int column = static_cast<int>((static_cast<double>(i) / 2.0 + 0.25) * kCell * pixel_size_.x());
    sample_at_[i] = std::min(column, image.cols - 1) * channels_;
  }
}

void Frame::shrink(const cv::Mat& image)
{
  const bool bytes = image.depth() == CV_8U;
  if (scale_ == 0.5 && bytes) {
    const auto halve = channels_ == 3 ? kernels::halveGreen : kernels::halveGrey;
    for (int y = 0; y < green_.rows; ++y) halve(image.ptr(2 * y), image.ptr(2 * y + 1), green_.cols, green_[y]);
    return;
  }
  // Sixteen bits through the resampling, so that nothing is rounded on the way to ten.
  cv::extractChannel(image, channel_, channels_ == 3 ? 1 : 0);
  channel_.convertTo(wide_, CV_16U, to_ten_bits_ * 64.0);
  const cv::Rect even(0, 0, scale_ == 0.5 ? 2 * green_.cols : wide_.cols, scale_ == 0.5 ? 2 * green_.rows : wide_.rows);
  cv::resize(wide_(even), green_, green_.size(), 0.0, 0.0, cv::INTER_AREA);
  green_.convertTo(green_, CV_16U, 1.0 / 64.0);
}

void Frame::averageCells()
{
  const int whole = width() / kCell;
  auto* scratch = reinterpret_cast<std::uint16_t*>(rows_.data());
  for (int y = 0; y < cell_green_.rows; ++y) {
    const std::uint16_t* rows[kCell];
    for (int j = 0; j < kCell; ++j) rows[j] = green_[std::min(y * kCell + j, height() - 1)];
    kernels::averageFourRows(rows, whole * kCell, scratch, cell_green_[y]);
    if (whole < cell_green_.cols) cell_green_(y, whole) = rows[0][width() - 1];
  }
}

void Frame::sampleColours(const cv::Mat& image)
{
  const double step = kCell * pixel_size_.y();
  const auto gain = static_cast<float>(to_eight_bits_ / 2.0);
  const int blue_to_red = channels_ == 3 ? 2 : 0;
  for (int y = 0; y < cell_red_.rows; ++y) {
    const int upper = std::min(static_cast<int>((y + 0.25) * step), image.rows - 1);
    const int lower = std::min(static_cast<int>((y + 0.75) * step), image.rows - 1);
    if (image.depth() == CV_8U) {
      sampleRow(image.ptr<std::uint8_t>(upper), image.ptr<std::uint8_t>(lower), sample_at_, blue_to_red, gain,
                cell_red_[y], cell_blue_[y]);
    } else {
      sampleRow(image.ptr<std::uint16_t>(upper), image.ptr<std::uint16_t>(lower), sample_at_, blue_to_red, gain,
                cell_red_[y], cell_blue_[y]);
    }
  }
}

void Frame::estimateBackground(const OcclusionMask& mask)
{
  for (int y = 0; y < weight_.rows; ++y) {
    const std::uint8_t* hidden = mask.cells()[y];
    const std::uint16_t* green = cell_green_[y];
    float* weight = weight_[y];
    float* weighted = weighted_[y];
    for (int x = 0; x < weight_.cols; ++x) {
      weight[x] = hidden[x] == OcclusionMask::kVisible ? 1.0F : 0.0F;
      weighted[x] = weight[x] * static_cast<float>(green[x]);
    }
  }
  for (const int radius : {options_.background_radius_cells, 1}) {
    boxSum(weight_, radius, box_);
    boxSum(weighted_, radius, box_);
  }
  for (int y = 0; y < weight_.rows; ++y) {
    const float* weight = weight_[y];
    const float* weighted = weighted_[y];
    float* inverse = inverse_background_[y];
    for (int x = 0; x < weight_.cols; ++x) {
      // Where nothing is visible nearby the contrast means nothing, but it must be finite.
      const float background = weighted[x] > 0.0F ? weighted[x] / weight[x] : static_cast<float>(kContrastUnit);
      inverse[x] = static_cast<float>(kContrastUnit) / background;
    }
  }
}

void Frame::normalise(const OcclusionMask& mask)
{
  estimateBackground(mask);
  const int cells = inverse_background_.cols;
  const std::size_t padded = static_cast<std::size_t>(cells) * kCell + 2;
  float* gains = row_gain_.data() + cells + 2;
  std::int16_t* scratch = rows_.data() + 3 * padded;
  const auto rough = [&](int y) { return rows_.data() + static_cast<std::size_t>(y % 3) * padded; };
  const auto fill = [&](int y) {
    const float at = (static_cast<float>(y) - 1.5F) / kCell;
    const int upper = std::clamp(static_cast<int>(std::floor(at)), 0, inverse_background_.rows - 1);
    const int lower = std::min(upper + 1, inverse_background_.rows - 1);
    kernels::expandGains(inverse_background_[upper], inverse_background_[lower],
                         std::max(0.0F, at - static_cast<float>(upper)), cells, row_gain_.data(), gains);
    kernels::normaliseRow(green_[y], gains, width(), rough(y));
  };
  fill(0);
  for (int y = 0; y < height(); ++y) {
    const int below = std::min(y + 1, height() - 1);
    if (below > y) fill(below);
    kernels::smoothRow(rough(std::max(y - 1, 0)), rough(y), rough(below), width(), scratch, contrast_[y]);
  }
}

}  // namespace eyeslam::tracking
