// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/latency_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "eyeslam/trials/error_figures.h"
#include "eyeslam/trials/svg_canvas.h"
#include "eyeslam/trials/svg_chart.h"

namespace eyeslam::trials {

namespace {

constexpr double kWidth = 1080.0, kLeft = 62.0;  // px
constexpr std::size_t kBins = 40;

struct Latency {
  std::string name, unit;
  double per_second;
  std::vector<double> TrialRecord::*values;
};

std::vector<double> gathered(const std::vector<const TrialRecord*>& trials, const Latency& latency)
{
  std::vector<double> values;
  for (const TrialRecord* trial : trials)
    for (const double value : trial->*latency.values) values.push_back(latency.per_second * value);
  return values;
}

void drawHistogram(const Latency& latency, const std::vector<double>& values, const Box& plot, SvgCanvas& canvas)
{
  const ErrorFigures figures = errorFigures(values);
  const double width = std::max(1.02 * figures.max, 1e-9) / static_cast<double>(kBins);
  std::vector<double> counts(kBins, 0.0);
  for (const double value : values)
    counts[std::min(static_cast<std::size_t>(std::max(0.0, value) / width), kBins - 1)] += 1.0;
  for (double& count : counts) count *= 100.0 / static_cast<double>(values.size());
  SvgChart chart(canvas, plot, {fmt::format("{} ({})", latency.name, latency.unit), 0.0, width * kBins},
                 Axis::fromZero("share (%)", *std::max_element(counts.begin(), counts.end())));
  chart.title(
      fmt::format("median {:.3g}, p95 {:.3g}, max {:.3g} {}", figures.median, figures.p95, figures.max, latency.unit));
  chart.axes();
  for (std::size_t i = 0; i < kBins; ++i)
    if (counts[i] > 0.0)
      chart.bar(width * (static_cast<double>(i) + 0.06), width * (static_cast<double>(i) + 0.94), counts[i],
                Paint::area("#56b4e9"));
  chart.vertical(figures.median, Paint::line("#222", 1.2));
  chart.vertical(figures.p95, Paint::dashed("#222", 1.2, "4 3"));
}

}  // namespace

std::string latencyFigure(const std::vector<const TrialRecord*>& trials)
{
  const std::vector<Latency> latencies{
      {"age of a pose when it arrives", "ms", 1e3, &TrialRecord::pose_ages_s},
      {"exposure to the command that uses it", "ms", 1e3, &TrialRecord::frame_to_command_s},
      {"CPU time of the longest cycle", "\u00b5s", 1e6, &TrialRecord::computation_s}};
  SvgCanvas canvas(kWidth, 280.0, "latencies");
  const double step = kWidth / static_cast<double>(latencies.size());
  double at = 0.0;
  for (const Latency& latency : latencies) {
    const std::vector<double> values = gathered(trials, latency);
    if (values.empty()) continue;
    drawHistogram(latency, values, boxAt(at + kLeft, 30.0, step - kLeft - 20.0, 195.0), canvas);
    at += step;
  }
  return at > 0.0 ? canvas.svg() : std::string();
}

}  // namespace eyeslam::trials
