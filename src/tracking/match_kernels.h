// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

namespace eyeslam::tracking {

// The inner loops of scan matching, free of any notion but arrays, so that they can be compiled for wider vectors.

inline constexpr int kSumColumns = 16;    ///< that sumSixteenColumns gives at once
inline constexpr int kBoundColumns = 32;  ///< that sumBounds gives at once

/// Turned and shifted points, floored: cell_x[n] = floor(c x[n] - s y[n] + tx), cell_y[n] = floor(s x[n] + c y[n] +
/// ty).
void floorTurned(const double* x, const double* y, int count, const double (&turn)[4], std::int32_t* cell_x,
                 std::int32_t* cell_y);

/// sums[r * 16 + c] = sum over n of table[offsets[n] + r * stride + c], for 16 columns; reads 16 bytes a row.
void sumSixteenColumns(const std::uint8_t* table, std::ptrdiff_t stride, const std::int32_t* offsets, int count,
                       int rows, std::uint32_t* sums);
/// Adds rows of 4-bit bounds: sums[r * sums_stride + c] = sum over n of planes[offsets[n] + r * stride + c], c <
/// columns rounded up to 32. Each bound is at most 16, so fifteen of them fit in a byte; count is at most 4000.
void sumBounds(const std::uint8_t* planes, std::ptrdiff_t stride, const std::int32_t* offsets, int count, int rows,
               int columns, std::uint16_t* sums, std::ptrdiff_t sums_stride);

/// pooled[x] = maximum of four rows of `table` and of columns x to x + 3, for x up to stride - 4; beyond that, of
/// fewer.
void poolSmall(const std::uint8_t* table, std::ptrdiff_t stride, std::uint8_t* scratch, std::uint8_t* pooled);
/// bounds[x] = maximum of the 8 x 8 cells from x on, made of the `small` ones, in sixteenths of 256 rounded up.
void poolLarge(const std::uint8_t* small, std::ptrdiff_t stride, int width, std::uint8_t* bounds);

}  // namespace eyeslam::tracking
