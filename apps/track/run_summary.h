// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "eyeslam/files/trajectory_file.h"

namespace eyeslam::apps {

/// Counts and times of a run, for `run.json` and the last line.
class RunSummary {
 public:
  void add(const files::TrajectoryRow& row);

  std::int64_t frames() const { return frames_; }
  std::int64_t tracked() const { return tracked_; }
  /// Frames by reason, as in `trajectory.csv`.
  nlohmann::ordered_json counts() const;
  /// Median, 99th percentile and largest CPU time of tracker and map; ms.
  nlohmann::ordered_json timing(double wall_s) const;
  double medianCpuMs() const { return quantile(cpu_ms_, 0.5); }

 private:
  // A histogram, so that memory does not grow with the video: bins of 0.02 ms, the last one holds all that is longer.
  struct Histogram {
    static constexpr double kBin_ms = 0.02;
    std::vector<std::int64_t> bins = std::vector<std::int64_t>(10000, 0);
    std::int64_t count = 0;
    double largest = 0.0;
    void add(double ms);
  };
  static double quantile(const Histogram& histogram, double q);
  static nlohmann::ordered_json times(const Histogram& histogram);

  std::int64_t frames_ = 0;
  std::int64_t tracked_ = 0;
  std::map<std::string, std::int64_t> reasons_;
  Histogram cpu_ms_;
  Histogram map_cpu_ms_;
};

}  // namespace eyeslam::apps
