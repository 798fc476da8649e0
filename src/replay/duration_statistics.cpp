// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/duration_statistics.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::replay {
namespace {

const double kStep = std::log(1.02);

}  // namespace

void DurationStatistics::add(std::int64_t duration_us)
{
  const double us = static_cast<double>(duration_us);
  const int at = duration_us < 1 ? 0 : 1 + static_cast<int>(std::log(us) / kStep);
  ++classes_[static_cast<std::size_t>(std::min(at, kClasses - 1))];
  lowest_ = count_ == 0 ? duration_us : std::min(lowest_, duration_us);
  highest_ = count_ == 0 ? duration_us : std::max(highest_, duration_us);
  sum_ += us;
  ++count_;
}

double DurationStatistics::quantile(double share) const
{
  const auto wanted = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count_)));
  if (wanted >= count_) return static_cast<double>(highest_);
  std::int64_t below = 0;
  std::size_t at = 0;
  while (at + 1 < classes_.size() && (below += classes_[at]) < std::max<std::int64_t>(wanted, 1)) ++at;
  const double middle = at == 0 ? static_cast<double>(lowest_) : std::exp((static_cast<double>(at) - 0.5) * kStep);
  return std::clamp(middle, static_cast<double>(lowest_), static_cast<double>(highest_));
}

}  // namespace eyeslam::replay
