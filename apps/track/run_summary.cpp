// SPDX-License-Identifier: GPL-3.0-or-later
#include "track/run_summary.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/reason.h"

namespace eyeslam::apps {

namespace {

double rounded(double value) { return std::round(1e4 * value) / 1e4; }

}  // namespace

void RunSummary::Histogram::add(double ms)
{
  const auto last = static_cast<double>(bins.size() - 1);
  ++bins[static_cast<std::size_t>(std::clamp(ms / kBin_ms, 0.0, last))];
  ++count;
  largest = std::max(largest, ms);
}

void RunSummary::add(const files::TrajectoryRow& row)
{
  ++frames_;
  if (row.result.tracked)
    ++tracked_;
  else
    ++reasons_[std::string(retina::word(row.result.reason))];
  cpu_ms_.add(row.cpu_ms);
  map_cpu_ms_.add(row.map_cpu_ms);
}

double RunSummary::quantile(const Histogram& histogram, double q)
{
  const auto wanted = static_cast<std::int64_t>(std::ceil(q * static_cast<double>(histogram.count)));
  std::int64_t passed = 0;
  for (std::size_t bin = 0; bin < histogram.bins.size(); ++bin) {
    passed += histogram.bins[bin];
    if (passed >= wanted) return std::min((static_cast<double>(bin) + 1.0) * Histogram::kBin_ms, histogram.largest);
  }
  return histogram.largest;
}

nlohmann::ordered_json RunSummary::times(const Histogram& histogram)
{
  return {{"median", rounded(quantile(histogram, 0.5))},
          {"p99", rounded(quantile(histogram, 0.99))},
          {"max", rounded(histogram.largest)}};
}

nlohmann::ordered_json RunSummary::counts() const
{
  return {{"frames", frames_}, {"tracked", tracked_}, {"not_tracked", reasons_}};
}

nlohmann::ordered_json RunSummary::timing(double wall_s) const
{
  return {{"cpu_ms", times(cpu_ms_)},
          {"map_cpu_ms", times(map_cpu_ms_)},
          {"wall_s", rounded(wall_s)},
          {"frames_per_s", rounded(static_cast<double>(frames_) / std::max(wall_s, 1e-3))}};
}

}  // namespace eyeslam::apps
