// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/report_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "eyeslam/trials/aid_style.h"
#include "eyeslam/trials/report_warnings.h"

namespace eyeslam::trials {

namespace {

constexpr const char* kNothing = "\u2013";

std::string cell(const std::optional<double>& value) { return value ? fmt::format("{:.4g}", *value) : kNothing; }

void addHeadline(std::vector<Headline>& headlines, const std::optional<double>& value, const char* format,
                 const std::string& unit, const std::string& name)
{
  if (value) headlines.push_back({fmt::format(fmt::runtime(format), *value), unit, name});
}

struct Column {
  std::string name;
  std::optional<double> (*of)(const TrialScore&);
};

std::optional<double> percent(const std::optional<double>& share)
{
  return share ? std::optional<double>(100.0 * *share) : std::nullopt;
}
std::optional<double> number(const std::optional<std::int64_t>& count)
{
  return count ? std::optional<double>(static_cast<double>(*count)) : std::nullopt;
}

using Score = const TrialScore&;

std::vector<Column> columnsOf(const std::string& task)
{
  if (task == "laser")
    return {{"mean (\u00b5m)", [](Score s) { return s.placement_mean_um; }},
            {"p95 (\u00b5m)", [](Score s) { return s.placement_p95_um; }},
            {"max (\u00b5m)", [](Score s) { return s.placement_max_um; }},
            {"burns/s", [](Score s) { return s.burns_per_s; }},
            {"targets", [](Score s) { return number(s.targets); }},
            {"fired", [](Score s) { return number(s.fired); }},
            {"refused", [](Score s) { return number(s.refused); }},
            {"missed", [](Score s) { return number(s.missed); }},
            {"far", [](Score s) { return number(s.far_pulses); }},
            {"clearance (\u00b5m)", [](Score s) { return s.min_vessel_clearance_um; }}};
  return {{"RMS (\u00b5m)", [](Score s) { return s.rms_um; }},
          {"median (\u00b5m)", [](Score s) { return s.median_um; }},
          {"p95 (\u00b5m)", [](Score s) { return s.p95_um; }},
          {"max (\u00b5m)", [](Score s) { return s.max_um; }},
          {"covered (%)", [](Score s) { return percent(s.path_coverage); }},
          {"time (s)", [](Score s) { return std::optional<double>(s.duration_s); }},
          {"travel (mm)", [](Score s) { return s.tip_travel_mm; }}};
}

std::vector<Column> columnsOfLoop()
{
  return {{"pose RMS (px)", [](Score s) { return s.pose_rms_px; }},
          {"pose RMS (deg)", [](Score s) { return s.pose_rms_deg; }},
          {"tracked (%)", [](Score s) { return percent(s.tracked_fraction); }},
          {"saturated (%)", [](Score s) { return std::optional<double>(100.0 * s.saturated_fraction); }},
          {"holds", [](Score s) { return number(s.hold_events); }},
          {"faults", [](Score s) { return number(s.fault_events); }}};
}

/// Three digits of the mean, and as many places of the spread.
std::string withSpread(const OverSeeds& over, std::size_t count)
{
  if (count < 2 && over.mean == std::round(over.mean)) return fmt::format("{:.0f}", over.mean);  // counts, mostly
  const double magnitude = std::abs(over.mean);
  const int places = magnitude < 1e-9 ? 0 : std::clamp(2 - static_cast<int>(std::floor(std::log10(magnitude))), 0, 4);
  if (count < 2) return fmt::format("{:.{}f}", over.mean, places);
  return fmt::format("{:.{}f} \u00b1 {:.{}f}", over.mean, places, over.spread, places);
}

std::string meanAndSpread(const AidTrials& aid, const Column& column)
{
  std::vector<double> values;
  for (const TrialRecord* trial : aid.trials)
    if (const std::optional<double> value = column.of(trial->score)) values.push_back(*value);
  return values.empty() ? kNothing : withSpread(meanOverSeeds(values), values.size());
}

std::string meanOf(const PairedComparison& figures, const OverSeeds& over, const std::string& unit)
{
  return withSpread(over, figures.pairs) + (unit == "um" ? " \u00b5m" : " " + unit);
}

ReportTable tableOf(const StudyGroup& group, const std::vector<Column>& columns)
{
  ReportTable table{{"aid", "seeds"}, {}};
  for (const Column& column : columns) table.names.push_back(column.name);
  for (const AidTrials& aid : group.aids) {
    std::vector<std::string> row{styleOf(aid.aid).name, std::to_string(aid.trials.size())};
    for (const Column& column : columns) row.push_back(meanAndSpread(aid, column));
    table.rows.push_back(std::move(row));
  }
  return table;
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
  if (score.fired) {
    const auto burnt = std::count_if(record.targets.begin(), record.targets.end(),
                                     [](const PlannedTarget& target) { return target.fate == "done"; });
    headlines.push_back({fmt::format("{}", burnt), fmt::format("of {}", score.targets.value_or(0)),
                         fmt::format("targets burnt; {} refused, {} missed; {} pulses", score.refused.value_or(0),
                                     score.missed.value_or(0), *score.fired)});
  }
  addHeadline(headlines, score.burns_per_s, "{:.2f}", "/s", "pulses");
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
  ReportTable table{{"time (s)", "what", "reason", ""}, {}, 4};
  for (const TrialEvent& event : events)
    table.rows.push_back({fmt::format("{:.3f}", event.t_s), event.what, event.reason, event.warning ? "warning" : ""});
  return table;
}

ReportTable pulseTable(const std::vector<PulseRecord>& pulses)
{
  ReportTable table{{"target", "time (s)", "pulse (ms)", "off (\u00b5m)", "burn length (\u00b5m)",
                     "to the nearest vessel (\u00b5m)", "calibre touched (\u00b5m)", "far"},
                    {}};
  for (const PulseRecord& pulse : pulses) {
    const char* far = !pulse.far ? "" : pulse.explained ? "explained" : "unexplained";
    table.rows.push_back({std::to_string(pulse.target), fmt::format("{:.3f}", pulse.t_s),
                          fmt::format("{:.0f}", 1e3 * pulse.duration), fmt::format("{:.1f}", 1e6 * pulse.placement),
                          fmt::format("{:.0f}", 1e6 * pulse.length), fmt::format("{:.0f}", 1e6 * pulse.clearance),
                          pulse.touched_calibre > 0.0 ? fmt::format("{:.0f}", 1e6 * pulse.touched_calibre) : "", far});
  }
  return table;
}

ReportTable targetTable(const TrialRecord& record)
{
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const PlannedTarget& target : record.targets) ++counts[{target.fate, target.reason}];
  ReportTable table{{"fate", "reason", "targets"}, {}, 2};
  for (const auto& [why, count] : counts) table.rows.push_back({why.first, why.second, std::to_string(count)});
  return table;
}

ReportTable aidTable(const StudyGroup& group) { return tableOf(group, columnsOf(group.task)); }
ReportTable loopTable(const StudyGroup& group) { return tableOf(group, columnsOfLoop()); }

std::string reductionOf(const PairedComparison& figures)
{
  const Estimate& estimate = figures.reduction_percent;
  if (figures.pairs < kSeedsForInterval) return fmt::format("{:.1f}\u00a0%", estimate.value);
  return fmt::format("{:.1f}\u00a0% ({:.1f}\u00a0to\u00a0{:.1f})", estimate.value, estimate.low, estimate.high);
}

ReportTable verdictTable(const StudyGroup& group)
{
  ReportTable table{{"trial", "verdict", "what had to happen, and what did"}, {}, 3};
  for (const AidTrials& aid : group.aids)
    for (const TrialRecord* trial : aid.trials)
      if (trial->passed) table.rows.push_back({nameOf(*trial), *trial->passed ? "passed" : "FAILED", trial->verdict});
  return table;
}

ReportTable comparisonTable(const std::vector<AidComparison>& comparisons)
{
  ReportTable table{{"aid", "measure", "seeds", "without", "with", "reduction (95 % CI)", "seeds worse"}, {}, 2};
  for (const AidComparison& comparison : comparisons) {
    const PairedComparison& figures = comparison.figures;
    if (figures.pairs == 0) continue;
    const auto worse = std::count(figures.worse.begin(), figures.worse.end(), true);
    table.rows.push_back({styleOf(comparison.aid).name, comparison.measure.name, std::to_string(figures.pairs),
                          meanOf(figures, figures.unaided, comparison.measure.unit),
                          meanOf(figures, figures.aided, comparison.measure.unit), reductionOf(figures),
                          fmt::format("{} of {}", worse, figures.pairs)});
  }
  return table;
}

ReportTable trialTable(const StudyGroup& group)
{
  std::vector<Column> columns = columnsOf(group.task);
  for (const Column& column : columnsOfLoop()) columns.push_back(column);
  ReportTable table{{"aid", "seed"}, {}};
  for (const Column& column : columns) table.names.push_back(column.name);
  table.names.emplace_back("warnings");
  for (const AidTrials& aid : group.aids)
    for (const TrialRecord* trial : aid.trials) {
      std::vector<std::string> row{styleOf(aid.aid).name, std::to_string(trial->score.seed)};
      for (const Column& column : columns) row.push_back(cell(column.of(trial->score)));
      row.push_back(std::to_string(warningsOf(*trial).size()));
      table.rows.push_back(std::move(row));
    }
  return table;
}

ReportTable touchTable(const StudyGroup& group)
{
  ReportTable table{
      {"aid", "burns", "touch none (%)", "below 20 \u00b5m (%)", "20 to 50 \u00b5m (%)", "50 \u00b5m or more (%)"}, {}};
  for (const AidTrials& aid : group.aids) {
    double burns = 0.0, clear = 0.0;
    std::array<double, kCalibreClasses.size()> touched{}, covered{}, maps{};
    for (const TrialRecord* trial : aid.trials) {
      for (const PulseRecord& pulse : trial->pulses) {
        burns += 1.0;
        (pulse.touched_calibre > 0.0 ? touched[calibreClass(pulse.touched_calibre)] : clear) += 1.0;
      }
      for (std::size_t kind = 0; kind < covered.size(); ++kind) {
        if (!trial->map.coverage[kind]) continue;
        covered[kind] += *trial->map.coverage[kind];
        maps[kind] += 1.0;
      }
    }
    if (burns == 0.0) continue;
    table.rows.push_back(
        {styleOf(aid.aid).name, fmt::format("{:.0f}", burns), fmt::format("{:.2f}", 100.0 * clear / burns)});
    for (const double count : touched) table.rows.back().push_back(fmt::format("{:.2f}", 100.0 * count / burns));
    if (std::all_of(maps.begin(), maps.end(), [](double count) { return count == 0.0; })) continue;
    table.rows.push_back({"its map has, of such vessels' area", "", ""});
    for (std::size_t kind = 0; kind < covered.size(); ++kind)
      table.rows.back().push_back(maps[kind] > 0.0 ? fmt::format("{:.1f}", 100.0 * covered[kind] / maps[kind]) : "");
  }
  return table;
}

ReportTable publishedTable(const StudyGroup& group, const std::vector<AidComparison>& comparisons)
{
  ReportTable table{{"what", "here", "published", "where"}, {}, 4};
  const auto reduction = [&](const std::string& measure) -> std::string {
    for (const AidComparison& comparison : comparisons)
      if (comparison.aid == "automated" && comparison.measure.name == measure && comparison.figures.pairs > 0)
        return reductionOf(comparison.figures);
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
