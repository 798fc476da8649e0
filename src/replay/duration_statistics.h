// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace eyeslam::replay {

/// How long something took, over any number of cases in 8 kB: count, extremes and mean exact, quantiles within 1 %.
class DurationStatistics {
 public:
  void add(std::int64_t duration_us);

  std::int64_t count() const { return count_; }
  std::int64_t lowest() const { return lowest_; }    ///< us; 0 of none
  std::int64_t highest() const { return highest_; }  ///< us; 0 of none
  double mean() const { return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_); }
  /// us, of the case that a share of all does not exceed; durations below 1 us count as the lowest one.
  /// @param share  [0, 1]
  double quantile(double share) const;

 private:
  static constexpr int kClasses = 1024;

  std::array<std::int64_t, kClasses> classes_{};  // 0: below 1 us; then each 2 % longer than the one before
  std::int64_t count_ = 0, lowest_ = 0, highest_ = 0;
  double sum_ = 0.0;
};

}  // namespace eyeslam::replay
