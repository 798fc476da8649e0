// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace eyeslam::tracking::kernels {

/// Sums the green of 2 x 2 blocks of two BGR rows; `count` blocks.
void halveGreen(const std::uint8_t* upper, const std::uint8_t* lower, int count, std::uint16_t* sums);
/// Sums 2 x 2 blocks of two grey rows; `count` blocks.
void halveGrey(const std::uint8_t* upper, const std::uint8_t* lower, int count, std::uint16_t* sums);
/// Adds four rows of `count` values, then groups of four columns: sixteen times the cell means.
void averageFourRows(const std::uint16_t* const rows[4], int count, std::uint16_t* scratch, std::uint16_t* means);
/// Expands a row of gains at the centres of cells of four px to pixels, linearly; 4 x `cells` values.
void expandGains(const float* upper, const float* lower, float lower_share, int cells, float* scratch, float* gains);
/// contrast = clip(green x gain - unit), `count` values.
void normaliseRow(const std::uint16_t* green, const float* gains, int count, std::int16_t* contrast);
/// [1 2 1] / 4 down three rows, then along; the ends repeat. `scratch` holds count + 2 values.
void smoothRow(const std::int16_t* above, const std::int16_t* middle, const std::int16_t* below, int count,
               std::int16_t* scratch, std::int16_t* smooth);
/// sums[i] += rows[i] and the like: adds, subtracts a row of floats.
void addRow(const float* row, int count, float* sums);

}  // namespace eyeslam::tracking::kernels
