// SPDX-License-Identifier: GPL-3.0-or-later
#include "trial/trial_summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "eyeslam/trials/report_tables.h"
#include "eyeslam/trials/report_warnings.h"
#include "eyeslam/trials/study_groups.h"

namespace eyeslam::apps {
namespace {

using trials::ReportTable;
using trials::StudyGroup;

constexpr std::size_t kWarningsShown = 12;

// Letters of UTF-8, not bytes.
std::size_t widthOf(const std::string& text)
{
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char letter) { return (letter & 0xC0) != 0x80; }));
}

// Words stand to the left, numbers to the right.
std::string lineOf(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths, std::size_t words)
{
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string space(widths[i] - widthOf(cells[i]), ' ');
    line += "  " + (i < words ? cells[i] + space : space + cells[i]);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string textOf(const ReportTable& table)
{
  if (table.rows.empty()) return "";
  std::vector<std::size_t> widths(table.names.size(), 0);
  const auto widen = [&widths](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], widthOf(cells[i]));
  };
  widen(table.names);
  for (const std::vector<std::string>& row : table.rows) widen(row);
  std::string text = lineOf(table.names, widths, table.words);
  for (const std::vector<std::string>& row : table.rows) text += lineOf(row, widths, table.words);
  return text;
}

std::string warningsText(const std::vector<std::string>& warnings)
{
  std::string text;
  const std::size_t shown = std::min(warnings.size(), kWarningsShown);
  for (std::size_t i = 0; i < shown; ++i) text += "warning: " + warnings[i] + "\n";
  if (shown < warnings.size()) text += fmt::format("warning: and {} more, in the report\n", warnings.size() - shown);
  return text;
}

}  // namespace

std::string summaryOf(const std::vector<trials::TrialRecord>& records)
{
  const std::vector<StudyGroup> groups = trials::groupsOf(records);
  std::string text = warningsText(trials::warningsOf(records, groups));
  for (const StudyGroup& group : groups) {
    text += fmt::format("{}{}\n", group.scenario, group.variant.empty() ? "" : ", " + group.variant);
    text += textOf(trials::aidTable(group));
    text += textOf(trials::comparisonTable(trials::comparisonsOf(group)));
    text += textOf(trials::verdictTable(group));
  }
  return text;
}

std::size_t failuresAmong(const std::vector<trials::TrialRecord>& records)
{
  return static_cast<std::size_t>(std::count_if(records.begin(), records.end(), [](const trials::TrialRecord& r) {
    return !r.passed.value_or(true) || r.score.interlock_violations.value_or(0) > 0;
  }));
}

}  // namespace eyeslam::apps
