// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/files/log_event.h"
#include "eyeslam/replay/duration_statistics.h"

namespace eyeslam::replay {

/// How far goals of MICRON_COMMAND are from the recorded ones, of pairs in which both are goals of the same thing.
class GoalDistances {
 public:
  void add(const files::LogEvent& recorded, const files::LogEvent& recomputed);

  std::int64_t count() const { return nanometres_.count(); }
  /// um; of the goal that a share of all does not exceed, within 1 %.
  double quantile(double share) const { return 1e-3 * nanometres_.quantile(share); }
  double largest() const { return 1e-3 * static_cast<double>(nanometres_.highest()); }

 private:
  DurationStatistics nanometres_;  // which are counted as microseconds are
};

}  // namespace eyeslam::replay
