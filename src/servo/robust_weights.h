// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace eyeslam::servo {

/// Tukey's biweight of a residual given in units of the cut: 1 at 0, 0 from the cut on.
inline double biweight(double of_cut) noexcept
{
  const double inside = std::max(0.0, 1.0 - of_cut * of_cut);
  return inside * inside;
}

/// The upper median of at least one value; their order is lost.
inline double medianOf(std::vector<double>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace eyeslam::servo
