// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/report_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "eyeslam/trials/aid_style.h"
#include "eyeslam/trials/report_warnings.h"

namespace eyeslam::trials {

namespace {

constexpr const char* kNothing = "\u2013";

template <class Value>
std::string cell(const std::optional<Value>& value, const char* format = "{:.3g}")
{
  return value ? fmt::format(fmt::runtime(format), *value) : kNothing;
}

void addHeadline(std::vector<Headline>& headlines, const std::optional<double>& value, const char* format,
                 const std::string& unit, const std::string& name)
{
  if (value) headlines.push_back({fmt::format(fmt::runtime(format), *value), unit, name});
}

struct Column {
  std::string name;
  std::function<std::optional<double>(const TrialScore&)> of;
  const char* format = "{:.3g}";
};

std::optional<double> percent(const std::optional<double>& share)
{
  return share ? std::optional<double>(100.0 * *share) : std::nullopt;
}
std::optional<double> number(const std::optional<std::int64_t>& count)
{
  return count ? std::optional<double>(static_cast<double>(*count)) : std::nullopt;
}

std::vector<Column> columnsOf(const std::string& task)
{
  using Score = const TrialScore&;
  const std::vector<Column> of_vision{
      {"pose RMS (px)", [](Score s) { return s.pose_rms_px; }},
      {"tracked (%)", [](Score s) { return percent(s.tracked_fraction); }, "{:.1f}"},
      {"saturated (%)", [](Score s) { return std::optional<double>(100.0 * s.saturated_fraction); }, "{:.2g}"}};
  std::vector<Column> columns;
  if (task == "laser") {
    columns = {{"mean (\u00b5m)", [](Score s) { return s.placement_mean_um; }},
               {"p95 (\u00b5m)", [](Score s) { return s.placement_p95_um; }},
               {"max (\u00b5m)", [](Score s) { return s.placement_max_um; }},
               {"burns/s", [](Score s) { return s.burns_per_s; }},
               {"targets", [](Score s) { return number(s.targets); }},
               {"fired", [](Score s) { return number(s.fired); }},
               {"refused", [](Score s) { return number(s.refused); }},
               {"missed", [](Score s) { return number(s.missed); }},
               {"far", [](Score s) { return number(s.far_pulses); }},
               {"clearance (\u00b5m)", [](Score s) { return s.min_vessel_clearance_um; }}};
  } else {
    columns = {{"RMS (\u00b5m)", [](Score s) { return s.rms_um; }},
               {"median (\u00b5m)", [](Score s) { return s.median_um; }},
               {"p95 (\u00b5m)", [](Score s) { return s.p95_um; }},
               {"max (\u00b5m)", [](Score s) { return s.max_um; }},
               {"covered (%)", [](Score s) { return percent(s.path_coverage); }},
               {"travel (mm)", [](Score s) { return s.tip_travel_mm; }}};
  }
  columns.insert(columns.end(), of_vision.begin(), of_vision.end());
  return columns;
}

std::string meanAndSpread(const AidTrials& aid, const Column& column)
{
  std::vector<double> values;
  for (const TrialRecord* trial : aid.trials)
    if (const std::optional<double> value = column.of(trial->score)) values.push_back(*value);
  if (values.empty()) return kNothing;
  const OverSeeds over = meanOverSeeds(values);
  const std::string mean = fmt::format(fmt::runtime(column.format), over.mean);
  return values.size() > 1 ? fmt::format("{} \u00b1 {:.2g}", mean, over.spread) : mean;
}

std::string meanOf(const OverSeeds& over, const std::string& unit)
{
  return fmt::format("{:.3g} \u00b1 {:.2g} {}", over.mean, over.spread, unit == "um" ? "\u00b5m" : unit);
}

}  // namespace

std::vector<Headline> headlinesOf(const TrialRecord& record)
{
  const TrialScore& score = record.score;
  std::vector<Headline> headlines;
  if (record.passed) headlines.push_back({*record.passed ? "passed" : "failed", "", record.verdict});
  addHeadline(headlines, score.rms_um, "{:.1f}", "\u00b5m", "RMS error of the tip");
  addHeadline(headlines, score.median_um, "{:.1f}", "\u00b5m", "median");
  addHeadline(headlines, score.p95_um, "{:.1f}", "\u00b5m", "95th percentile");
  addHeadline(headlines, score.max_um, "{:.0f}", "\u00b5m", "greatest");
  addHeadline(headlines, percent(score.path_coverage), "{:.0f}", "%", "of the path covered");
  addHeadline(headlines, score.placement_mean_um, "{:.1f}", "\u00b5m", "mean placement error");
  addHeadline(headlines, score.placement_p95_um, "{:.1f}", "\u00b5m", "95th percentile of placement");
  if (score.fired)
    headlines.push_back(
        {fmt::format("{}", *score.fired), fmt::format("of {}", score.targets.value_or(0)),
         fmt::format("targets burnt; {} refused, {} missed", score.refused.value_or(0), score.missed.value_or(0))});
  addHeadline(headlines, score.burns_per_s, "{:.2f}", "/s", "burns");
  addHeadline(headlines, score.min_vessel_clearance_um, "{:.0f}", "\u00b5m",
              "least distance of a burn to a true vessel");
  addHeadline(headlines, score.pose_rms_px, "{:.2f}", "px", "RMS of localization, half resolution");
  return headlines;
}

ReportTable scoreTable(const TrialScore& score)
{
  ReportTable table{{"score", "value"}, {}};
  const std::vector<std::string> row = trials::rowOf(score);
  for (std::size_t i = 0; i < row.size(); ++i)
    if (!row[i].empty()) table.rows.push_back({columns()[i], row[i]});
  for (const auto& [name, value] : score.more) table.rows.push_back({name, fmt::format("{:.6g}", value)});
  return table;
}

ReportTable eventTable(const std::vector<TrialEvent>& events)
{
  ReportTable table{{"time (s)", "what", "reason", ""}, {}, true};
  for (const TrialEvent& event : events)
    table.rows.push_back({fmt::format("{:.3f}", event.t_s), event.what, event.reason, event.warning ? "warning" : ""});
  return table;
}

ReportTable targetTable(const TrialRecord& record)
{
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const PlannedTarget& target : record.targets) ++counts[{target.fate, target.reason}];
  ReportTable table{{"fate", "reason", "targets"}, {}, true};
  for (const auto& [why, count] : counts) table.rows.push_back({why.first, why.second, std::to_string(count)});
  return table;
}

ReportTable aidTable(const StudyGroup& group)
{
  const std::vector<Column> columns = columnsOf(group.task);
  ReportTable table{{"aid", "seeds"}, {}};
  for (const Column& column : columns) table.names.push_back(column.name);
  for (const AidTrials& aid : group.aids) {
    std::vector<std::string> row{styleOf(aid.aid).name, std::to_string(aid.trials.size())};
    for (const Column& column : columns) row.push_back(meanAndSpread(aid, column));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string percentWithInterval(const Estimate& estimate)
{
  return fmt::format("{:.1f} % ({:.1f} to {:.1f})", estimate.value, estimate.low, estimate.high);
}

ReportTable comparisonTable(const std::vector<AidComparison>& comparisons)
{
  ReportTable table{{"aid", "measure", "seeds", "without", "with", "reduction (95 % CI)", "seeds worse"}, {}};
  for (const AidComparison& comparison : comparisons) {
    const PairedComparison& figures = comparison.figures;
    if (figures.pairs == 0) continue;
    const auto worse = std::count(figures.worse.begin(), figures.worse.end(), true);
    table.rows.push_back(
        {styleOf(comparison.aid).name, comparison.measure.name, std::to_string(figures.pairs),
         meanOf(figures.unaided, comparison.measure.unit), meanOf(figures.aided, comparison.measure.unit),
         percentWithInterval(figures.reduction_percent), fmt::format("{} of {}", worse, figures.pairs)});
  }
  return table;
}

ReportTable trialTable(const std::vector<TrialRecord>& records)
{
  const bool laser = std::any_of(records.begin(), records.end(), [](const auto& r) { return r.task == "laser"; });
  const bool tip = std::any_of(records.begin(), records.end(), [](const auto& r) { return r.task != "laser"; });
  std::vector<Column> columns;
  if (tip) columns = columnsOf("trace");
  for (const Column& column : laser ? columnsOf("laser") : std::vector<Column>())
    if (std::none_of(columns.begin(), columns.end(), [&](const Column& c) {
          return c.name == column.name && tip && c.name != "p95 (\u00b5m)" && c.name != "max (\u00b5m)";
        }))
      columns.push_back(column);
  ReportTable table{{"trial"}, {}};
  for (const Column& column : columns) table.names.push_back(column.name);
  table.names.insert(table.names.end(), {"holds", "faults", "warnings"});
  for (const TrialRecord& record : records) {
    std::vector<std::string> row{nameOf(record)};
    for (const Column& column : columns) row.push_back(cell(column.of(record.score), column.format));
    row.insert(row.end(), {std::to_string(record.score.hold_events), std::to_string(record.score.fault_events),
                           std::to_string(warningsOf(record).size())});
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable touchTable(const StudyGroup& group)
{
  const std::vector<double> edges{0.0, 20e-6, 50e-6, 1.0};  // m; from 50 um on none is allowed
  ReportTable table{
      {"aid", "burns", "touch none (%)", "below 20 \u00b5m (%)", "20 to 50 \u00b5m (%)", "50 \u00b5m or more (%)"}, {}};
  for (const AidTrials& aid : group.aids) {
    double burns = 0.0;
    std::vector<double> touched(edges.size(), 0.0);
    for (const TrialRecord* trial : aid.trials) {
      for (const PulseRecord& pulse : trial->pulses) {
        burns += 1.0;
        const auto edge = pulse.touched_calibre > 0.0
                              ? std::upper_bound(edges.begin(), edges.end(), pulse.touched_calibre)
                              : edges.begin();
        touched[std::min(static_cast<std::size_t>(edge - edges.begin()), touched.size() - 1)] += 1.0;
      }
    }
    if (burns == 0.0) continue;
    table.rows.push_back({styleOf(aid.aid).name, fmt::format("{:.0f}", burns)});
    for (const double count : touched) table.rows.back().push_back(fmt::format("{:.2f}", 100.0 * count / burns));
  }
  return table;
}

ReportTable publishedTable(const StudyGroup& group, const std::vector<AidComparison>& comparisons)
{
  ReportTable table{{"what", "here", "published", "where"}, {}, true};
  const auto reduction = [&](const std::string& measure) -> std::string {
    for (const AidComparison& comparison : comparisons)
      if (comparison.aid == "automated" && comparison.measure.name == measure && comparison.figures.pairs > 0)
        return percentWithInterval(comparison.figures.reduction_percent);
    return {};
  };
  const char* kIros = "automated against unaided, fixed target: Toward Automated Intraocular Laser Surgery, IROS 2014";
  if (const std::string error = reduction("mean placement error"); !error.empty())
    table.rows.push_back({"less placement error of automated burns", error, "63.6 %", kIros});
  if (const std::string time = reduction("time per burn"); !time.empty())
    table.rows.push_back({"less time for a burn", time, "28.5 %", kIros});
  const AidTrials& strongest = group.aids.back();
  const std::string px = meanAndSpread(strongest, {"", [](const TrialScore& s) { return s.pose_rms_px; }});
  if (px != kNothing)
    table.rows.push_back({"RMS of localization, px", px, "4.8 (human, in vivo), 7.6 (porcine, ex vivo)",
                          "EyeSLAM paper, Table II: against fiducials labelled by hand"});
  return table;
}

}  // namespace eyeslam::trials
