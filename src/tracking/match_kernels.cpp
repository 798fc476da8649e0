// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/match_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "eyeslam/retina/vector_kernel.h"

namespace eyeslam::tracking {

namespace {

constexpr int kBytesPerWord = 256;  // values up to 255 that a 16-bit sum holds
constexpr int kBoundsPerByte = 15;  // bounds up to 16 that an 8-bit sum holds
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "a word's lower byte is the left column");

// Sums of sixteen bytes without widening them: eight words are added as they come, which makes even + 256 odd modulo
// 2^16, and their upper bytes once more alone. Sums stay in registers over all points.
template <int kRows>
[[gnu::always_inline]] inline void sumInWords(const std::uint8_t* table, std::ptrdiff_t stride,
                                              const std::int32_t* offsets, int count, std::uint32_t* sums)
{
  using Words [[gnu::vector_size(kSumColumns)]] = std::uint16_t;
  Words both[kRows] = {}, odd[kRows] = {};
  for (int n = 0; n < count; ++n) {
    const std::uint8_t* row = table + offsets[n];
    for (int r = 0; r < kRows; ++r, row += stride) {
      Words words;
      std::memcpy(&words, row, kSumColumns);
      both[r] += words;
      odd[r] += words >> 8;
    }
  }
  for (int r = 0; r < kRows; ++r) {
    const Words even = both[r] - (odd[r] << 8);
    for (int c = 0; c < kSumColumns / 2; ++c) {
      sums[r * kSumColumns + 2 * c] += even[c];
      sums[r * kSumColumns + 2 * c + 1] += odd[r][c];
    }
  }
}

template <int kRows>
[[gnu::always_inline]] inline void sumRows(const std::uint8_t* table, std::ptrdiff_t stride,
                                           const std::int32_t* offsets, int count, std::uint32_t* sums)
{
  std::memset(sums, 0, kRows * kSumColumns * sizeof(*sums));
  for (int first = 0; first < count; first += kBytesPerWord) {
    sumInWords<kRows>(table, stride, offsets + first, std::min(kBytesPerWord, count - first), sums);
  }
}

}  // namespace

EYESLAM_VECTOR_KERNEL
void floorTurned(const double* x, const double* y, int count, const double (&turn)[4], std::int32_t* cell_x,
                 std::int32_t* cell_y)
{
  const double c = turn[0], s = turn[1], tx = turn[2], ty = turn[3];
  for (int n = 0; n < count; ++n) {
    cell_x[n] = static_cast<std::int32_t>(std::floor(c * x[n] - s * y[n] + tx));
    cell_y[n] = static_cast<std::int32_t>(std::floor(s * x[n] + c * y[n] + ty));
  }
}

EYESLAM_VECTOR_KERNEL
void sumSixteenColumns(const std::uint8_t* table, std::ptrdiff_t stride, const std::int32_t* offsets, int count,
                       int rows, std::uint32_t* sums)
{
  int r = 0;
  for (; r + 4 <= rows; r += 4) sumRows<4>(table + r * stride, stride, offsets, count, sums + r * kSumColumns);
  for (; r + 3 <= rows; r += 3) sumRows<3>(table + r * stride, stride, offsets, count, sums + r * kSumColumns);
  for (; r < rows; ++r) sumRows<1>(table + r * stride, stride, offsets, count, sums + r * kSumColumns);
}

EYESLAM_VECTOR_KERNEL
void sumBounds(const std::uint8_t* planes, std::ptrdiff_t stride, const std::int32_t* offsets, int count, int rows,
               int columns, std::uint16_t* sums, std::ptrdiff_t sums_stride)
{
  using Bytes [[gnu::vector_size(kBoundColumns)]] = std::uint8_t;
  for (int r = 0; r < rows; ++r) {
    for (int column = 0; column < columns; column += kBoundColumns) {
      const std::uint8_t* first = planes + r * stride + column;
      std::uint16_t words[kBoundColumns] = {};
      for (int done = 0; done < count; done += kBoundsPerByte) {
        Bytes total = {};
        const int end = std::min(count, done + kBoundsPerByte);
        for (int n = done; n < end; ++n) {
          Bytes bytes;
          std::memcpy(&bytes, first + offsets[n], kBoundColumns);
          total += bytes;
        }
        std::uint8_t totals[kBoundColumns];
        std::memcpy(totals, &total, kBoundColumns);
        for (int c = 0; c < kBoundColumns; ++c) words[c] = static_cast<std::uint16_t>(words[c] + totals[c]);
      }
      std::memcpy(sums + r * sums_stride + column, words, sizeof(words));
    }
  }
}

EYESLAM_VECTOR_KERNEL
void poolSmall(const std::uint8_t* table, std::ptrdiff_t stride, std::uint8_t* scratch, std::uint8_t* pooled)
{
  const std::uint8_t* below = table + stride;
  const std::uint8_t* second = below + stride;
  const std::uint8_t* third = second + stride;
  for (std::ptrdiff_t x = 0; x < stride; ++x) {
    scratch[x] = std::max(std::max(table[x], below[x]), std::max(second[x], third[x]));
  }
  for (std::ptrdiff_t x = 0; x + 3 < stride; ++x) {
    pooled[x] = std::max(std::max(scratch[x], scratch[x + 1]), std::max(scratch[x + 2], scratch[x + 3]));
  }
  for (std::ptrdiff_t x = stride - 3; x < stride; ++x) pooled[x] = scratch[x];
}

EYESLAM_VECTOR_KERNEL
void poolLarge(const std::uint8_t* small, std::ptrdiff_t stride, int width, std::uint8_t* bounds)
{
  const std::uint8_t* lower = small + 4 * stride;
  for (int x = 0; x < width; ++x) {
    const std::uint8_t most = std::max(std::max(small[x], small[x + 4]), std::max(lower[x], lower[x + 4]));
    bounds[x] = static_cast<std::uint8_t>((most >> 4) + ((most & 15) != 0 ? 1 : 0));
  }
}

}  // namespace eyeslam::tracking
