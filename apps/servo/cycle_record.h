// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "real_time/real_time_loop.h"

namespace eyeslam::apps {

/// `--timing`: how late the newest cycles began and what they took. Allocates at the start only.
class CycleRecord {
 public:
  static constexpr std::size_t kHalfAnHour = 1'800'000;  ///< cycles

  /// @param most  cycles that are kept, 0: none
  explicit CycleRecord(std::size_t most) : rows_(most) {}

  /// A cycle begins; for the loop.
  void add(const CycleStart& start) noexcept;
  /// After the loop: `utime,lateness_us,computation_us` a row, the computation that of the cycle before.
  std::string csv() const;

 private:
  struct Row {
    std::int64_t utime = 0;
    float lateness_us = 0.0F;
    float computation_us = 0.0F;
  };

  std::vector<Row> rows_;
  std::size_t count_ = 0;
};

}  // namespace eyeslam::apps
