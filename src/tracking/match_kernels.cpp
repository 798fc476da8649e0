// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/match_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "eyeslam/tracking/vector_kernel.h"

namespace eyeslam::tracking {

namespace {

constexpr int kBytesPerWord = 256;  // values up to 255 that a 16-bit sum holds
constexpr int kBoundsPerByte = 15;  // bounds up to 16 that an 8-bit sum holds
constexpr int kColumns = 16;
constexpr int kBoundColumns = 32;
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "a word's lower byte is the left column");

// Sums of sixteen bytes without widening them: eight words are added as they come, which makes even + 256 odd modulo
// 2^16, and their upper bytes once more alone. Sums stay in registers over all points.
template <int kRows>
[[gnu::always_inline]] inline void sumInWords(const std::uint8_t* table, std::ptrdiff_t stride,
                                              const std::int32_t* offsets, int count, std::uint32_t* sums)
{
  using Words [[gnu::vector_size(kColumns)]] = std::uint16_t;
  Words both[kRows] = {}, odd[kRows] = {};
  for (int n = 0; n < count; ++n) {
    const std::uint8_t* row = table + offsets[n];
    for (int r = 0; r < kRows; ++r, row += stride) {
      Words words;
      std::memcpy(&words, row, kColumns);
      both[r] += words;
      odd[r] += words >> 8;
    }
  }
  for (int r = 0; r < kRows; ++r) {
    const Words even = both[r] - (odd[r] << 8);
    for (int c = 0; c < kColumns / 2; ++c) {
      sums[r * kColumns + 2 * c] += even[c];
      sums[r * kColumns + 2 * c + 1] += odd[r][c];
    }
  }
}

template <int kRows>
[[gnu::always_inline]] inline void sumRows(const std::uint8_t* table, std::ptrdiff_t stride,
                                           const std::int32_t* offsets, int count, std::uint32_t* sums)
{
  std::memset(sums, 0, kRows * kColumns * sizeof(*sums));
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
  for (; r + 4 <= rows; r += 4) sumRows<4>(table + r * stride, stride, offsets, count, sums + r * kColumns);
  for (; r + 3 <= rows; r += 3) sumRows<3>(table + r * stride, stride, offsets, count, sums + r * kColumns);
  for (; r < rows; ++r) sumRows<1>(table + r * stride, stride, offsets, count, sums + r * kColumns);
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
void poolEightByEight(const std::uint8_t* table, std::ptrdiff_t stride, int width, std::uint8_t* scratch,
                      std::uint8_t* bounds)
{
  const int wide = width + 8;
  std::memcpy(scratch, table, static_cast<std::size_t>(wide));
  for (int r = 1; r < 8; ++r) {
    const std::uint8_t* row = table + r * stride;
    for (int x = 0; x < wide; ++x) scratch[x] = std::max(scratch[x], row[x]);
  }
  // In place, left to right: each value only looks at what lies to its right and is not yet pooled.
  for (int reach = 1; reach < 8; reach *= 2) {
    for (int x = 0; x + reach < wide; ++x) scratch[x] = std::max(scratch[x], scratch[x + reach]);
  }
  for (int x = 0; x < width; ++x) {
    bounds[x] = static_cast<std::uint8_t>((scratch[x] >> 4) + ((scratch[x] & 15) != 0 ? 1 : 0));
  }
}

}  // namespace eyeslam::tracking
