// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/error_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "eyeslam/trials/aid_style.h"
#include "eyeslam/trials/bootstrap.h"
#include "eyeslam/trials/figure_layout.h"
#include "eyeslam/trials/svg_canvas.h"
#include "eyeslam/trials/svg_chart.h"

namespace eyeslam::trials {

namespace {

constexpr double kRmsWindow_s = 0.5;
constexpr std::size_t kColumns = 900;
constexpr const char* kFastMotion = "#ececf4";

struct ErrorSeries {
  std::vector<double> t_s, um;
};

struct Distribution {
  std::vector<double> um, percent;
};

ErrorSeries seriesOf(const TrialRecord& trial)
{
  ErrorSeries series;
  for (const TipSample& sample : trial.tip) {
    series.t_s.push_back(sample.t_s);
    series.um.push_back(1e6 * sample.error);
  }
  return series;
}

/// RMS over half a second around each of some places.
ErrorSeries runningRms(const ErrorSeries& series)
{
  ErrorSeries result;
  if (series.t_s.empty()) return result;
  std::vector<double> squares{0.0};
  for (const double error : series.um) squares.push_back(squares.back() + error * error);
  const double end = series.t_s.back();
  for (double t = series.t_s.front(); t <= end; t += 0.2 * kRmsWindow_s) {
    const auto index = [&](double at) {
      return static_cast<std::size_t>(std::lower_bound(series.t_s.begin(), series.t_s.end(), at) - series.t_s.begin());
    };
    const std::size_t from = index(t - 0.5 * kRmsWindow_s), to = index(t + 0.5 * kRmsWindow_s);
    if (to <= from) continue;
    result.t_s.push_back(t);
    result.um.push_back(std::sqrt((squares[to] - squares[from]) / static_cast<double>(to - from)));
  }
  return result;
}

void shadeFastMotion(const TrialRecord& trial, SvgChart& chart)
{
  for (std::size_t i = 0; i < trial.tip.size(); ++i) {
    if (trial.tip[i].calm) continue;
    const double from = trial.tip[i].t_s;
    while (i + 1 < trial.tip.size() && !trial.tip[i + 1].calm) ++i;
    chart.shade(from, trial.tip[i].t_s, Paint::area(kFastMotion));
  }
}

void drawSeries(const TrialRecord& trial, SvgChart& chart)
{
  const ErrorSeries series = seriesOf(trial);
  const std::string colour = styleOf(trial.score.aid).colour;
  const Envelope all = envelope(series.t_s, series.um, kColumns);
  chart.band(all.x, all.low, all.high, Paint::area(colour, 0.45));
  const ErrorSeries rms = runningRms(series);
  chart.curve(rms.t_s, rms.um, Paint::line("#fff", 3.4, 0.8));
  chart.curve(rms.t_s, rms.um, Paint::line(colour, 1.8));
}

void markEvents(const std::vector<const TrialRecord*>& trials, double end_s, SvgChart& chart)
{
  for (const TrialRecord* trial : trials)
    for (const TrialEvent& event : trial->events)
      if (event.warning && event.t_s >= 0.0 && event.t_s <= end_s)
        chart.vertical(event.t_s, Paint::dashed("#b00020", 1.2, "3 2"));
}

double greatestOf(const std::vector<const TrialRecord*>& trials)
{
  double greatest = 0.0;
  for (const TrialRecord* trial : trials)
    for (const TipSample& sample : trial->tip) greatest = std::max(greatest, 1e6 * sample.error);
  return greatest;
}

void drawOverTime(const std::vector<const TrialRecord*>& trials, const Box& plot, const std::string& title,
                  SvgCanvas& canvas)
{
  double end_s = 1.0;
  for (const TrialRecord* trial : trials)
    if (!trial->tip.empty()) end_s = std::max(end_s, trial->tip.back().t_s);
  SvgChart chart(canvas, plot, {"time (s)", 0.0, end_s}, Axis::fromZero("error (\u00b5m)", greatestOf(trials)));
  const bool alone = trials.size() == 1;  // each trial is of another stretch of the eye's motion
  if (alone) shadeFastMotion(*trials.back(), chart);
  chart.title(title);
  chart.axes();
  std::vector<Key> keys;
  for (const TrialRecord* trial : trials) {
    drawSeries(*trial, chart);
    keys.push_back({styleOf(trial->score.aid).name, Paint::line(styleOf(trial->score.aid).colour, 3.0)});
  }
  markEvents(trials, end_s, chart);
  if (alone) keys.push_back({"fast motion of the retina", Paint::area(kFastMotion)});
  chart.legend(keys);
}

std::vector<double> errorsOf(const TrialRecord& trial)
{
  std::vector<double> errors;
  for (const TipSample& sample : trial.tip) errors.push_back(1e6 * sample.error);
  for (const PulseRecord& pulse : trial.pulses) errors.push_back(1e6 * pulse.placement);
  std::sort(errors.begin(), errors.end());
  return errors;
}

/// The share of sorted values that is not greater, in percent: every step where they are few, else some quantiles.
Distribution sharesOf(const std::vector<double>& sorted, std::size_t wanted)
{
  Distribution curve;
  const bool all = sorted.size() <= wanted;
  const std::size_t steps = all ? sorted.size() : wanted;
  const double share = 100.0 / static_cast<double>(std::max<std::size_t>(sorted.size(), 1));
  for (std::size_t i = 0; i < steps; ++i) {
    const std::size_t at = all ? i : i * (sorted.size() - 1) / (steps - 1);
    if (all) {
      curve.um.push_back(sorted[at]);
      curve.percent.push_back(share * static_cast<double>(at));
    }
    curve.um.push_back(sorted[at]);
    curve.percent.push_back(share * static_cast<double>(at + 1));
  }
  return curve;
}

std::vector<double> pooledErrors(const AidTrials& aid)
{
  std::vector<double> pooled;
  for (const TrialRecord* trial : aid.trials) {
    const std::vector<double> errors = errorsOf(*trial);
    pooled.insert(pooled.end(), errors.begin(), errors.end());
  }
  std::sort(pooled.begin(), pooled.end());
  return pooled;
}

struct Values {
  std::vector<std::uint64_t> seeds;
  std::vector<double> values;
};

Values valuesOf(const AidTrials& aid, const Measure& measure)
{
  Values result;
  for (const TrialRecord* trial : aid.trials) {
    if (!measure.of(trial->score)) continue;
    result.seeds.push_back(trial->score.seed);
    result.values.push_back(*measure.of(trial->score));
  }
  return result;
}

void drawMean(const std::vector<double>& values, double x, const std::string& colour, SvgChart& chart)
{
  const auto mean = [&](const std::vector<std::size_t>& chosen) {
    double sum = 0.0;
    for (const std::size_t index : chosen) sum += values[index];
    return sum / static_cast<double>(chosen.size());
  };
  const Estimate estimate = bootstrap(values.size(), mean);
  if (values.size() >= kSeedsForInterval) {
    chart.curve({x, x}, {estimate.low, estimate.high}, Paint::line(colour, 2.0));
    chart.curve({x - 0.06, x + 0.06}, {estimate.low, estimate.low}, Paint::line(colour, 2.0));
    chart.curve({x - 0.06, x + 0.06}, {estimate.high, estimate.high}, Paint::line(colour, 2.0));
  }
  chart.dot(x, estimate.value, 4.5, {"#fff", colour, 2.0, 1.0, {}}, fmt::format("mean {:.4g}", estimate.value));
}

void joinSeeds(const std::vector<Values>& aids, SvgChart& chart)
{
  for (std::size_t i = 1; i < aids.size(); ++i)
    for (std::size_t k = 0; k < aids[i].seeds.size(); ++k) {
      const auto before = std::find(aids[i - 1].seeds.begin(), aids[i - 1].seeds.end(), aids[i].seeds[k]);
      if (before == aids[i - 1].seeds.end()) continue;
      const auto partner = static_cast<std::size_t>(before - aids[i - 1].seeds.begin());
      chart.curve({static_cast<double>(i) - 1.0, static_cast<double>(i)},
                  {aids[i - 1].values[partner], aids[i].values[k]}, Paint::line("#999", 0.8, 0.6));
    }
}

void drawStrip(const StudyGroup& group, const Measure& measure, const Box& plot, SvgCanvas& canvas)
{
  std::vector<Values> aids;
  std::vector<std::string> names;
  double least = 1e12, greatest = 0.0;
  for (const AidTrials& aid : group.aids) {
    aids.push_back(valuesOf(aid, measure));
    names.push_back(styleOf(aid.aid).name);
    for (const double value : aids.back().values) {
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
  }
  const std::string label = fmt::format("{} ({})", measure.name, measure.unit == "um" ? "\u00b5m" : measure.unit);
  const bool wide = least > 0.0 && greatest > 6.0 * least;
  SvgChart chart(canvas, plot, {"", -0.5, static_cast<double>(names.size()) - 0.5},
                 wide ? Axis::decades(label, least, greatest) : Axis::fromZero(label, greatest));
  chart.title(measure.name);
  chart.axes(names);
  joinSeeds(aids, chart);
  for (std::size_t i = 0; i < aids.size(); ++i) {
    const std::string colour = styleOf(group.aids[i].aid).colour;
    for (std::size_t k = 0; k < aids[i].values.size(); ++k)
      chart.dot(static_cast<double>(i), aids[i].values[k], 3.2, Paint::area(colour, 0.75),
                fmt::format("seed {}: {:.4g} {}", aids[i].seeds[k], aids[i].values[k], measure.unit));
    if (!aids[i].values.empty()) drawMean(aids[i].values, static_cast<double>(i) + 0.22, colour, chart);
  }
}

}  // namespace

std::string errorOverTime(const std::vector<const TrialRecord*>& trials)
{
  const bool several = trials.size() > 1;
  SvgCanvas canvas(kFigureWidth, several ? 560.0 : 300.0, "error over time");
  const double width = kFigureWidth - kAxisWidth - 16.0;
  drawOverTime(trials, boxAt(kAxisWidth, 30.0, width, several ? 210.0 : 220.0),
               several ? "a\u00a0 all, in one scale" : "error of the tip", canvas);
  if (several)
    drawOverTime({trials.back()}, boxAt(kAxisWidth, 310.0, width, 200.0),
                 "b\u00a0 " + styleOf(trials.back()->score.aid).name + " alone", canvas);
  return canvas.svg();
}

std::string errorDistribution(const std::vector<AidTrials>& aids)
{
  SvgCanvas canvas(kFigureWidth, 380.0, "distribution of errors");
  std::vector<std::vector<double>> pooled;
  double least = 1e12, greatest = 1.0;
  for (const AidTrials& aid : aids) {
    pooled.push_back(pooledErrors(aid));
    if (pooled.back().empty()) continue;
    // Below a hundredth of the errors nothing is to be seen.
    least = std::min(least, std::max(0.1, pooled.back()[pooled.back().size() / 100]));
    greatest = std::max(greatest, pooled.back().back());
  }
  SvgChart chart(canvas, boxAt(kAxisWidth, 30.0, kFigureWidth - kAxisWidth - 16.0, 300.0),
                 Axis::decades("error (\u00b5m), logarithmic", std::min(least, greatest), greatest),
                 {"smaller than that (%)", 0.0, 100.0});
  chart.axes();
  std::vector<Key> keys;
  for (std::size_t i = 0; i < aids.size(); ++i) {
    const AidStyle style = styleOf(aids[i].aid);
    for (const TrialRecord* trial : aids[i].trials) {
      const Distribution thin = sharesOf(errorsOf(*trial), 60);
      if (aids[i].trials.size() > 1) chart.curve(thin.um, thin.percent, Paint::line(style.colour, 0.7, 0.35));
    }
    const Distribution thick = sharesOf(pooled[i], 300);
    chart.curve(thick.um, thick.percent, Paint::line(style.colour, 2.4));
    keys.push_back({style.name, Paint::line(style.colour, 2.4)});
  }
  chart.legend(keys);
  return canvas.svg();
}

std::string overSeedsFigure(const StudyGroup& group)
{
  const std::vector<Measure>& measures = measuresOf(group.task);
  const auto panels = static_cast<double>(measures.size());
  const double step = kFigureWidth / panels;
  SvgCanvas canvas(kFigureWidth, 350.0, "figures of each seed");
  for (std::size_t i = 0; i < measures.size(); ++i)
    drawStrip(group, measures[i],
              boxAt(kAxisWidth + step * static_cast<double>(i), 30.0, step - kAxisWidth - 24.0, 270.0), canvas);
  return canvas.svg();
}

}  // namespace eyeslam::trials
