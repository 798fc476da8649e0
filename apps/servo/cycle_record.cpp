// SPDX-License-Identifier: GPL-3.0-or-later
#include "servo/cycle_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace eyeslam::apps {

void CycleRecord::add(const CycleStart& start) noexcept
{
  if (rows_.empty()) return;
  rows_[count_++ % rows_.size()] = {start.utime, static_cast<float>(1e6 * start.lateness),
                                    static_cast<float>(1e6 * start.computation)};
}

std::string CycleRecord::csv() const
{
  std::string text = "utime,lateness_us,computation_us\n";
  for (std::size_t i = count_ - std::min(count_, rows_.size()); i < count_; ++i) {
    const Row& row = rows_[i % rows_.size()];
    fmt::format_to(std::back_inserter(text), "{},{:.1f},{:.1f}\n", row.utime, row.lateness_us, row.computation_us);
  }
  return text;
}

}  // namespace eyeslam::apps
