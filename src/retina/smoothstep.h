// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

namespace eyeslam::retina {

/// 3 x^2 - 2 x^3 for x in [0, 1], 0 below and 1 above: from rest to rest, without a jump in value or slope.
inline double smoothstep(double x) noexcept
{
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace eyeslam::retina
