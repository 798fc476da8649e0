// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/latency_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "eyeslam/trials/error_figures.h"
#include "eyeslam/trials/figure_layout.h"
#include "eyeslam/trials/svg_canvas.h"
#include "eyeslam/trials/svg_chart.h"

namespace eyeslam::trials {

namespace {

constexpr double kMostBins = 40.0;

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
  // Whole units, for values lie on a grid of their own that finer bins would count unevenly.
  const double width = std::max(1.0, std::ceil(figures.max / kMostBins));
  std::vector<double> counts(static_cast<std::size_t>(figures.max / width) + 1, 0.0);
  for (const double value : values) counts[static_cast<std::size_t>(std::max(0.0, value) / width)] += 1.0;
  for (double& count : counts) count *= 100.0 / static_cast<double>(values.size());
  SvgChart chart(canvas, plot,
                 {fmt::format("{} ({})", latency.name, latency.unit), 0.0, width * static_cast<double>(counts.size())},
                 Axis::fromZero("share (%)", *std::max_element(counts.begin(), counts.end())));
  chart.title(
      fmt::format("median {:.3g}, p95 {:.3g}, max {:.3g} {}", figures.median, figures.p95, figures.max, latency.unit));
  chart.axes();
  for (std::size_t i = 0; i < counts.size(); ++i)
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
  SvgCanvas canvas(kFigureWidth, 280.0, "latencies");
  std::vector<std::pair<Latency, std::vector<double>>> measured;
  for (const Latency& latency : latencies) {
    std::vector<double> values = gathered(trials, latency);
    if (!values.empty()) measured.emplace_back(latency, std::move(values));
  }
  const double step = kFigureWidth / static_cast<double>(std::max<std::size_t>(measured.size(), 1));
  double at = 0.0;
  for (const auto& [latency, values] : measured) {
    drawHistogram(latency, values, boxAt(at + kAxisWidth, 30.0, step - kAxisWidth - 20.0, 195.0), canvas);
    at += step;
  }
  return measured.empty() ? std::string() : canvas.svg();
}

}  // namespace eyeslam::trials
