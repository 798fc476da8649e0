// SPDX-License-Identifier: GPL-3.0-or-later
// 3x3 convolutions for net.py: planes of (height + 2) x stride floats, a margin of zeros around each, 64 bytes to
// spare.
#include <cstddef>
#include <cstring>

namespace {

using Vector = float __attribute__((vector_size(64), aligned(4)));
constexpr int kLanes = 16;
constexpr int kBlock = 4;

Vector load(const float* from)
{
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

float sum(Vector v)
{
  float s = 0;
  for (int k = 0; k < kLanes; ++k) s += v[k];
  return s;
}

struct Planes {
  int width, height, stride;
  std::size_t plane() const { return static_cast<std::size_t>(height + 2) * static_cast<std::size_t>(stride); }
  std::size_t at(int channel, int row) const { return channel * plane() + static_cast<std::size_t>(row) * stride; }
};

}  // namespace

extern "C" {

// out[o] = bias[o] + sum over i, taps of weight[o][i][tap] in[i]; `outputs` a multiple of 4.
void forward(const float* in, int inputs, float* out, int outputs, const float* weight, const float* bias, int width,
             int height, int stride)
{
  const Planes p{width, height, stride};
  for (int o = 0; o < outputs; o += kBlock) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; x += 2 * kLanes) {
        const bool two = x + kLanes < width;
        Vector acc[kBlock][2];
        for (int b = 0; b < kBlock; ++b) acc[b][0] = acc[b][1] = Vector{} + bias[o + b];
        for (int i = 0; i < inputs; ++i) {
          for (int dy = 0; dy < 3; ++dy) {
            const float* row = in + p.at(i, y + dy) + x;
            for (int dx = 0; dx < 3; ++dx) {
              const Vector a0 = load(row + dx);
              const Vector a1 = load(row + dx + kLanes);
              for (int b = 0; b < kBlock; ++b) {
                const float w = weight[(static_cast<std::size_t>(o + b) * inputs + i) * 9 + dy * 3 + dx];
                acc[b][0] += w * a0;
                acc[b][1] += w * a1;
              }
            }
          }
        }
        for (int b = 0; b < kBlock; ++b) {
          float* to = out + p.at(o + b, y + 1) + x + 1;
          std::memcpy(to, &acc[b][0], sizeof(Vector));
          if (two) std::memcpy(to + kLanes, &acc[b][1], sizeof(Vector));
        }
      }
    }
  }
}

// dweight[o][i][tap] += sum over pixels of dout[o] in[i].
void weightGradient(const float* in, int inputs, const float* dout, int outputs, float* dweight, int width, int height,
                    int stride)
{
  const Planes p{width, height, stride};
  for (int o = 0; o < outputs; o += kBlock) {
    for (int i = 0; i < inputs; ++i) {
      for (int dy = 0; dy < 3; ++dy) {
        Vector acc[kBlock][3] = {};
        for (int y = 0; y < height; ++y) {
          const float* row = in + p.at(i, y + dy);
          for (int x = 0; x < width; x += kLanes) {
            const Vector a[3] = {load(row + x), load(row + x + 1), load(row + x + 2)};
            for (int b = 0; b < kBlock; ++b) {
              const Vector d = load(dout + p.at(o + b, y + 1) + x + 1);
              for (int dx = 0; dx < 3; ++dx) acc[b][dx] += d * a[dx];
            }
          }
        }
        for (int b = 0; b < kBlock; ++b)
          for (int dx = 0; dx < 3; ++dx)
            dweight[(static_cast<std::size_t>(o + b) * inputs + i) * 9 + dy * 3 + dx] += sum(acc[b][dx]);
      }
    }
  }
}
}
