// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/frame_kernels.h"

#include <algorithm>
#include <cstring>

#include "eyeslam/retina/vector_kernel.h"
#include "eyeslam/tracking/frame.h"

namespace eyeslam::tracking::kernels {

namespace {

using Bytes = std::uint8_t __attribute__((vector_size(16)));
using Words = std::uint16_t __attribute__((vector_size(16)));

// A rounded quarter of a sum that fits sixteen bits; said so, or the compiler widens the vectors to 32.
inline std::int16_t quarter(int sum) { return static_cast<std::int16_t>(static_cast<std::int16_t>(sum + 2) >> 2); }

}  // namespace

// Sixteen BGR pixels are three vectors; two shuffles collect their greens, and adjacent ones are added as the low and
// high byte of a word.
EYESLAM_VECTOR_KERNEL void halveGreen(const std::uint8_t* upper, const std::uint8_t* lower, int count,
                                      std::uint16_t* sums)
{
  constexpr int kBlocks = 8;
  int block = 0;
  for (; block + kBlocks <= count; block += kBlocks) {
    Words total = {};
    for (const std::uint8_t* row : {upper, lower}) {
      Bytes a, b, c;
      std::memcpy(&a, row + 6 * block, sizeof a);
      std::memcpy(&b, row + 6 * block + 16, sizeof b);
      std::memcpy(&c, row + 6 * block + 32, sizeof c);
      const Bytes ab = __builtin_shufflevector(a, b, 1, 4, 7, 10, 13, 16, 19, 22, 25, 28, 31, 0, 0, 0, 0, 0);
      const Bytes green = __builtin_shufflevector(ab, c, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 18, 21, 24, 27, 30);
      Words pairs;
      std::memcpy(&pairs, &green, sizeof pairs);
      total += (pairs & 0xFF) + (pairs >> 8);
    }
    std::memcpy(sums + block, &total, sizeof total);
  }
  for (; block < count; ++block) {
    const int at = 6 * block + 1;
    sums[block] = static_cast<std::uint16_t>(upper[at] + upper[at + 3] + lower[at] + lower[at + 3]);
  }
}

EYESLAM_VECTOR_KERNEL void halveGrey(const std::uint8_t* upper, const std::uint8_t* lower, int count,
                                     std::uint16_t* sums)
{
  for (int i = 0; i < count; ++i) {
    sums[i] = static_cast<std::uint16_t>(upper[2 * i] + upper[2 * i + 1] + lower[2 * i] + lower[2 * i + 1]);
  }
}

EYESLAM_VECTOR_KERNEL void averageFourRows(const std::uint16_t* const rows[4], int count, std::uint16_t* scratch,
                                           std::uint16_t* means)
{
  const std::uint16_t *a = rows[0], *b = rows[1], *c = rows[2], *d = rows[3];
  for (int i = 0; i < count; ++i) scratch[i] = static_cast<std::uint16_t>(a[i] + b[i] + c[i] + d[i]);
  for (int i = 0; i < count / 4; ++i) {
    means[i] = static_cast<std::uint16_t>(
        (scratch[4 * i] + scratch[4 * i + 1] + scratch[4 * i + 2] + scratch[4 * i + 3] + 8) / 16);
  }
}

EYESLAM_VECTOR_KERNEL void expandGains(const float* upper, const float* lower, float lower_share, int cells,
                                       float* scratch, float* gains)
{
  // One cell of margin at both ends holds the end's value, so that every pixel lies between two centres.
  float* at = scratch + 1;
  for (int i = 0; i < cells; ++i) at[i] = upper[i] + lower_share * (lower[i] - upper[i]);
  at[-1] = at[0];
  at[cells] = at[cells - 1];
  for (int i = 0; i < cells; ++i) {
    const float left = at[i - 1] - at[i];
    const float right = at[i + 1] - at[i];
    gains[4 * i] = at[i] + 0.375F * left;
    gains[4 * i + 1] = at[i] + 0.125F * left;
    gains[4 * i + 2] = at[i] + 0.125F * right;
    gains[4 * i + 3] = at[i] + 0.375F * right;
  }
}

EYESLAM_VECTOR_KERNEL void normaliseRow(const std::uint16_t* green, const float* gains, int count,
                                        std::int16_t* contrast)
{
  // The ceiling keeps a + 2 b + c within sixteen bits in smoothRow.
  constexpr float kCeiling = 8000.0F;
  constexpr float kUnit = static_cast<float>(Frame::kContrastUnit);
  for (int i = 0; i < count; ++i) {
    const float value = std::min(static_cast<float>(green[i]) * gains[i] - kUnit, kCeiling);
    contrast[i] = static_cast<std::int16_t>(static_cast<int>(value));
  }
}

EYESLAM_VECTOR_KERNEL void smoothRow(const std::int16_t* above, const std::int16_t* middle, const std::int16_t* below,
                                     int count, std::int16_t* scratch, std::int16_t* smooth)
{
  std::int16_t* column = scratch + 1;
  for (int i = 0; i < count; ++i) {
    column[i] = quarter(above[i] + 2 * middle[i] + below[i]);
  }
  column[-1] = column[0];
  column[count] = column[count - 1];
  for (int i = 0; i < count; ++i) {
    smooth[i] = quarter(column[i - 1] + 2 * column[i] + column[i + 1]);
  }
}

EYESLAM_VECTOR_KERNEL void addRow(const float* row, int count, float* sums)
{
  for (int i = 0; i < count; ++i) sums[i] += row[i];
}

}  // namespace eyeslam::tracking::kernels
