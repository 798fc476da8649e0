// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "eyeslam/trials/aid_style.h"
#include "eyeslam/trials/burn_figure.h"
#include "eyeslam/trials/error_charts.h"
#include "eyeslam/trials/report_notes.h"
#include "eyeslam/trials/report_page.h"
#include "eyeslam/trials/report_sections.h"
#include "eyeslam/trials/report_tables.h"
#include "eyeslam/trials/report_warnings.h"
#include "eyeslam/trials/study_groups.h"
#include "eyeslam/trials/trial_report.h"

namespace eyeslam::trials {

namespace {

constexpr std::size_t kSideBySide = 2;

Headline headlineOf(const AidComparison& comparison)
{
  const Estimate& reduction = comparison.figures.reduction_percent;
  std::string name = comparison.measure.name + ", " + styleOf(comparison.aid).name;
  if (comparison.figures.pairs >= kSeedsForInterval)
    name += fmt::format(" (95 % CI of the reduction {:.1f} to {:.1f} %)", reduction.low, reduction.high);
  return {fmt::format("{}{:.1f}", reduction.value < 0.0 ? "+" : "\u2212", std::abs(reduction.value)), "%", name};
}

/// What the strongest aid changes; of a group without comparison the figures of its trial, where it is one.
std::vector<Headline> headlinesOf(const StudyGroup& group, const std::vector<AidComparison>& comparisons)
{
  std::vector<Headline> headlines;
  const AidTrials& strongest = group.aids.back();
  const AidComparison* first = nullptr;
  for (const AidComparison& comparison : comparisons) {
    if (comparison.aid != strongest.aid || comparison.figures.pairs == 0) continue;
    if (first == nullptr) first = &comparison;
    headlines.push_back(headlineOf(comparison));
  }
  if (first == nullptr && group.aids.size() == 1 && strongest.trials.size() == 1)
    return trials::headlinesOf(*strongest.trials.front());
  if (first == nullptr) return headlines;
  headlines.push_back({fmt::format("{:.1f}", first->figures.aided.mean), "\u00b5m",
                       fmt::format("{}, {}; {} {:.0f} \u00b5m", first->measure.name, styleOf(strongest.aid).name,
                                   styleOf(group.unaided()->aid).name, first->figures.unaided.mean)});
  headlines.push_back({fmt::format("{}", seedsMadeWorse(comparisons, strongest.aid).size()),
                       fmt::format("of {} seed{}", first->figures.pairs, first->figures.pairs == 1 ? "" : "s"),
                       "made worse by the aid, by 95th percentile or " + first->measure.name});
  return headlines;
}

/// The trials of a seed that are shown side by side: the unaided, and the strongest aid.
std::vector<const TrialRecord*> sideBySide(const StudyGroup& group, std::uint64_t seed)
{
  std::vector<const TrialRecord*> shown;
  const AidTrials* unaided = group.unaided();
  if (unaided != nullptr && group.aids.size() >= kSideBySide && unaided->ofSeed(seed) != nullptr)
    shown.push_back(unaided->ofSeed(seed));
  const TrialRecord* aided = group.aids.back().ofSeed(seed);
  if (aided != nullptr && (shown.empty() || shown.front() != aided)) shown.push_back(aided);
  return shown;
}

/// The median seed; where no trial was scored, any.
void addMedian(const StudyGroup& group, const std::string& name, ReportPage& page)
{
  const AidTrials& strongest = group.aids.back();
  const TrialRecord* median = examplesOf(strongest).median;
  if (median == nullptr) return addPictures({strongest.trials.front()}, name, page);
  if (strongest.trials.size() > 1)
    page.paragraph(fmt::format("Of {} seeds, the median by {} with {} is seed {}:", strongest.trials.size(),
                               measuresOf(group.task).front().name, styleOf(strongest.aid).name, median->score.seed));
  addPictures(sideBySide(group, median->score.seed), name, page);
}

void addWorst(const StudyGroup& group, const std::string& name, ReportPage& page)
{
  const Examples examples = examplesOf(group.aids.back());
  if (examples.worst == examples.median) return;
  page.paragraph(fmt::format("The worst is seed {}:", examples.worst->score.seed));
  addPictures(sideBySide(group, examples.worst->score.seed), name, page);
}

std::vector<const TrialRecord*> aidedTrials(const StudyGroup& group)
{
  std::vector<const TrialRecord*> trials;
  for (const AidTrials& aid : group.aids)
    if (!isUnaided(aid.aid)) trials.insert(trials.end(), aid.trials.begin(), aid.trials.end());
  return trials;
}

std::string titleOf(const StudyGroup& group)
{
  return group.scenario + (group.variant.empty() ? "" : ", " + group.variant);
}

void addStatistics(const StudyGroup& group, const std::vector<AidComparison>& comparisons, ReportPage& page)
{
  page.table(aidTable(group), "Mean \u00b1 standard deviation over seeds.");
  page.table(
      loopTable(group),
      "Localization against truth (px of the half-resolution image), and the loop; mean \u00b1 standard deviation.");
  page.table(comparisonTable(comparisons),
             "Paired comparison over seeds: reduction of the mean, of eight seeds and more with the 95 % interval of a "
             "percentile bootstrap over them (4000 resamples).");
  const bool several = group.aids.size() > 1 || group.aids.front().trials.size() > 1;
  page.figure(several ? overSeedsFigure(group) : std::string(),
              "A dot a trial, lines join one seed; circle: mean; bar: its 95 % bootstrap interval, of eight seeds and "
              "more.");
  page.figure(errorDistribution(group.aids),
              "Share of errors below each size: thick over all seeds, thin of each seed.");
  if (group.task != "laser") return;
  std::vector<std::vector<const TrialRecord*>> shown{group.aids.front().trials};
  if (group.aids.size() > 1) shown.push_back(group.aids.back().trials);
  page.figure(placementFigure(shown),
              "All burns as seen from their targets. Black ring: 60 \u00b5m, and farther counts as far; grey: 30, 120, "
              "240 \u00b5m.");
  page.table(touchTable(group), "Share of burns that touch a true vessel, by the calibre of the widest.");
}

void addGroup(const StudyGroup& group, const std::string& name, ReportPage& page)
{
  const std::vector<AidComparison> comparisons = comparisonsOf(group);
  page.section(titleOf(group));
  page.headlines(headlinesOf(group, comparisons));
  const AidTrials& first = group.unaided() != nullptr ? *group.unaided() : group.aids.front();
  if (!first.trials.empty()) page.note(operatorNote(*first.trials.front()));
  page.table(verdictTable(group), "Verdicts.");
  addMedian(group, name + "_median", page);
  addStatistics(group, comparisons, page);
  page.table(publishedTable(group, comparisons),
             "Beside published figures: of other experiments, eyes and judges, so they tell the size to expect.");
  addWorst(group, name + "_worst", page);
  const std::vector<const TrialRecord*> aided = aidedTrials(group);
  if (!aided.empty()) addLatencies(aided, page);
}

void addOrigin(const std::vector<TrialRecord>& records, const std::vector<StudyGroup>& groups, ReportPage& page)
{
  page.section("Trials and configuration");
  for (const StudyGroup& group : groups) page.foldedTable("Every trial of " + titleOf(group), trialTable(group));
  std::set<std::string> shown, versions;
  for (const TrialRecord& record : records) {
    versions.insert(record.score.version);
    if (!shown.insert(record.score.scenario + "\n" + record.variant).second) continue;
    page.folded(fmt::format("{}{}{}: every option, as YAML ({})", record.score.scenario,
                            record.variant.empty() ? "" : ", ", record.variant, record.score.config_hash),
                record.configuration);
  }
  std::string text;
  for (const std::string& version : versions) text += (text.empty() ? "" : ", ") + version;
  page.paragraph("Version " + text + ".");
}

}  // namespace

std::string studyReport(const std::vector<TrialRecord>& records, const std::vector<std::string>& missing)
{
  const std::vector<StudyGroup> groups = groupsOf(records);
  std::string title;
  std::set<std::string> named;
  for (const StudyGroup& group : groups)
    if (named.insert(group.scenario).second) title += (title.empty() ? "" : ", ") + group.scenario;
  ReportPage page(title.empty() ? "No trials" : title, fmt::format("{} trials", records.size()));
  std::vector<std::string> warnings = missing;
  for (std::string& warning : warningsOf(records, groups)) warnings.push_back(std::move(warning));
  page.warnings(warnings);
  page.note(truthNote());
  int number = 0;
  for (const StudyGroup& group : groups) addGroup(group, fmt::format("retina_{}", ++number), page);
  if (!records.empty()) addOrigin(records, groups, page);
  return page.html();
}

}  // namespace eyeslam::trials
