// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/vessel_net.h"

#include <algorithm>

#include "eyeslam/retina/vector_kernel.h"
#include "eyeslam/tracking/vessel_net_weights.h"

namespace eyeslam::tracking {

namespace {

enum class Cut { none, negative };  // of a layer's result

// The value of a base64 digit.
int digit(char c)
{
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : 63;
}

int storedValue(const char* base64, std::size_t at)
{
  const std::size_t bit = 8 * at;
  const int pair = (digit(base64[bit / 6]) << 6) | digit(base64[bit / 6 + 1]);
  return static_cast<std::int8_t>((pair >> (4 - bit % 6)) & 0xff);
}

// Ordered output, input, tap.
std::vector<float> unpack(const StoredLayer& from)
{
  const auto each = static_cast<std::size_t>(from.inputs * from.taps);
  std::vector<float> weights(static_cast<std::size_t>(from.outputs) * each);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    weights[k] = from.steps[k / each] * static_cast<float>(storedValue(from.weights, k));
  }
  return weights;
}

// Adds what one input gives to a row of one output. All nine taps in one pass: a load for each product, not three.
EYESLAM_VECTOR_KERNEL void addTaps(const float* above, const float* middle, const float* below, const float* weight,
                                   int width, float* __restrict sum)
{
  const float a = weight[0], b = weight[1], c = weight[2];
  const float d = weight[3], e = weight[4], f = weight[5];
  const float g = weight[6], h = weight[7], k = weight[8];
  for (int x = 0; x < width; ++x) {
    const float upper = a * above[x - 1] + b * above[x] + c * above[x + 1];
    const float centre = d * middle[x - 1] + e * middle[x] + f * middle[x + 1];
    const float lower = g * below[x - 1] + h * below[x] + k * below[x + 1];
    sum[x] += upper + (centre + lower);
  }
}

void convolveRow(const Planes& in, const float* weights, Cut cut, int y, float* row)
{
  for (int i = 0; i < in.channels(); ++i) {
    addTaps(in.row(i, y - 1), in.row(i, y), in.row(i, y + 1), weights + 9 * i, in.width(), row);
  }
  if (cut == Cut::none) return;
  for (int x = 0; x < in.width(); ++x) row[x] = std::max(row[x], 0.0F);
}

// The mean of 2x2 pixels.
EYESLAM_VECTOR_KERNEL void halve(const Planes& in, Planes& out)
{
  for (int c = 0; c < in.channels(); ++c) {
    for (int y = 0; y < out.height(); ++y) {
      const float* upper = in.row(c, 2 * y);
      const float* lower = in.row(c, 2 * y + 1);
      float* to = out.row(c, y);
      for (int x = 0; x < out.width(); ++x) {
        to[x] = 0.25F * (upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1]);
      }
    }
  }
}

EYESLAM_VECTOR_KERNEL void addScaled(const float* from, float weight, int width, float* __restrict sum)
{
  for (int x = 0; x < width; ++x) sum[x] += weight * from[x];
}

}  // namespace

Planes::Planes(int channels, int width, int height)
    : channels_(channels),
      width_(width),
      height_(height),
      values_(static_cast<std::size_t>(channels) * static_cast<std::size_t>(height + 2) *
              static_cast<std::size_t>(width + 2))
{}

VesselNet::VesselNet()
    : input_(8, kRegion / 2, kRegion / 2),
      fine1_(kVesselNetLayers[0].outputs, kRegion / 2, kRegion / 2),
      fine2_(fine1_),
      fine_sum_(fine1_),
      middle_in_(fine1_.channels(), kRegion / 4, kRegion / 4),
      middle1_(kVesselNetLayers[2].outputs, kRegion / 4, kRegion / 4),
      middle2_(middle1_),
      middle_sum_(middle1_),
      coarse_in_(middle1_.channels(), kRegion / 8, kRegion / 8),
      coarse1_(kVesselNetLayers[4].outputs, kRegion / 8, kRegion / 8),
      coarse2_(coarse1_),
      output_(8, kRegion / 2, kRegion / 2)
{
  for (const StoredLayer& stored : kVesselNetLayers) {
    const std::vector<float> bias(stored.bias, stored.bias + stored.outputs);
    layers_.push_back({stored.inputs, stored.outputs, unpack(stored), bias});
  }
}

void VesselNet::begin(const cv::Mat_<std::int16_t>& contrast, const cv::Mat_<std::uint8_t>& count)
{
  for (int y = 0; y < kRegion; ++y) {
    const std::int16_t* values = contrast[y];
    const std::uint8_t* counts = count[y];
    for (int p = 0; p < 2; ++p) {
      float* to = input_.row(phase(p, y), y / 2);
      float* seen = input_.row(4 + phase(p, y), y / 2);
      for (int x = 0; x < kRegion / 2; ++x) {
        const bool known = counts[2 * x + p] > 0 || values[2 * x + p] != 0;
        const float value = static_cast<float>(values[2 * x + p]) / kInputUnit;
        to[x] = known ? std::clamp(value, -kInputLimit, kInputLimit) : 0.0F;
        seen[x] = known ? 1.0F : 0.0F;
      }
    }
  }
  next_ = 0;
}

std::size_t VesselNet::convolve(const Planes& in, Planes& out)
{
  const Layer& layer = layers_[static_cast<std::size_t>(next_)];
  const Cut cut = next_ + 1 == kLayers ? Cut::none : Cut::negative;
  for (int output = 0; output < out.channels(); ++output) {
    const float* weights = layer.weights.data() + 9 * output * in.channels();
    for (int y = 0; y < in.height(); ++y) {
      std::fill_n(out.row(output, y), in.width(), layer.bias[static_cast<std::size_t>(output)]);
      convolveRow(in, weights, cut, y, out.row(output, y));
    }
  }
  return static_cast<std::size_t>(in.width() * in.height()) * layer.weights.size();
}

void VesselNet::join(int which, const Planes& coarse, const Planes& fine, Planes& sum)
{
  const Layer& by = layers_[static_cast<std::size_t>(kLayers + which)];
  for (int output = 0; output < fine.channels(); ++output) {
    const float* weights = by.weights.data() + output * coarse.channels();
    for (int y = 0; y < coarse.height(); ++y) {
      std::fill_n(mixed_.data(), coarse.width(), by.bias[static_cast<std::size_t>(output)]);
      for (int i = 0; i < coarse.channels(); ++i)
        addScaled(coarse.row(i, y), weights[i], coarse.width(), mixed_.data());
      for (int fine_y = 2 * y; fine_y < 2 * y + 2; ++fine_y) {
        const float* from = fine.row(output, fine_y);
        float* to = sum.row(output, fine_y);
        for (int x = 0; x < fine.width(); ++x) {
          to[x] = std::max(0.0F, from[x] + mixed_[static_cast<std::size_t>(x / 2)]);
        }
      }
    }
  }
}

std::size_t VesselNet::step()
{
  if (done()) return 0;
  std::size_t cost = 0;
  switch (next_) {
    case 0:
      cost = convolve(input_, fine1_);
      break;
    case 1:
      cost = convolve(fine1_, fine2_);
      halve(fine2_, middle_in_);
      break;
    case 2:
      cost = convolve(middle_in_, middle1_);
      break;
    case 3:
      cost = convolve(middle1_, middle2_);
      halve(middle2_, coarse_in_);
      break;
    case 4:
      cost = convolve(coarse_in_, coarse1_);
      break;
    case 5:
      cost = convolve(coarse1_, coarse2_);
      break;
    case 6:
      cost = convolve(coarse2_, coarse1_);
      join(0, coarse1_, middle2_, middle_sum_);
      break;
    case 7:
      cost = convolve(middle_sum_, middle1_);
      break;
    case 8:
      cost = convolve(middle1_, middle2_);
      join(1, middle2_, fine2_, fine_sum_);
      break;
    case 9:
      cost = convolve(fine_sum_, fine1_);
      break;
    case 10:
      cost = convolve(fine1_, fine2_);
      break;
    default:
      cost = convolve(fine2_, output_);
      break;
  }
  ++next_;
  return cost;
}

}  // namespace eyeslam::tracking
