// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/tip_errors.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::apps {

TipErrors::Figures TipErrors::figures() const
{
  if (errors_.empty()) return {};
  std::vector<float> sorted = errors_;
  std::sort(sorted.begin(), sorted.end());
  double squares = 0.0;
  for (const float error : sorted) squares += static_cast<double>(error) * static_cast<double>(error);
  const auto quantile = [&sorted](double q) {
    return static_cast<double>(sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))]);
  };
  return {std::sqrt(squares / static_cast<double>(sorted.size())), quantile(0.5), quantile(0.95)};
}

}  // namespace eyeslam::apps
