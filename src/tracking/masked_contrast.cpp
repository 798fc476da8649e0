// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/masked_contrast.h"

#include <cmath>

namespace eyeslam::tracking {

double sharpness(const MaskedContrast& picture)
{
  constexpr int kStep = 3;  // px; enough pixels for a mean, an eighth of the work
  double sum = 0.0;
  int count = 0;
  for (int y = 1; y < picture.height() - 1; y += kStep) {
    const std::int16_t *above = picture.contrast[y - 1], *here = picture.contrast[y], *below = picture.contrast[y + 1];
    for (int x = 1; x < picture.width() - 1; x += kStep) {
      if (!picture.isVisible(x, y)) continue;
      const double gx = 0.5 * (here[x + 1] - here[x - 1]), gy = 0.5 * (below[x] - above[x]);
      sum += gx * gx + gy * gy;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

}  // namespace eyeslam::tracking
