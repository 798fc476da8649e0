// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/study_groups.h"

#include <algorithm>
#include <sstream>

#include "eyeslam/trials/aid_style.h"

namespace eyeslam::trials {

namespace {

constexpr std::size_t kErrorMeasures = 2;  // the first of each task; the rest is time

std::string withoutAid(const std::string& variant)
{
  std::istringstream values(variant);
  std::string result, value;
  while (std::getline(values, value, ','))
    if (value.rfind("aid=", 0) != 0) result += (result.empty() ? "" : ",") + value;
  return result;
}

StudyGroup& groupFor(const TrialRecord& record, std::vector<StudyGroup>& groups)
{
  const std::string variant = withoutAid(record.variant);
  for (StudyGroup& group : groups)
    if (group.scenario == record.score.scenario && group.variant == variant) return group;
  return groups.emplace_back(StudyGroup{record.score.scenario, record.task, variant, {}});
}

void add(const TrialRecord& record, StudyGroup& group)
{
  auto aid = std::find_if(group.aids.begin(), group.aids.end(),
                          [&](const AidTrials& trials) { return trials.aid == record.score.aid; });
  if (aid == group.aids.end()) aid = group.aids.insert(aid, {record.score.aid, {}});
  if (aid->ofSeed(record.score.seed) == nullptr) aid->trials.push_back(&record);
}

void sort(StudyGroup& group)
{
  std::stable_sort(group.aids.begin(), group.aids.end(),
                   [](const AidTrials& a, const AidTrials& b) { return styleOf(a.aid).rank < styleOf(b.aid).rank; });
  for (AidTrials& aid : group.aids)
    std::sort(aid.trials.begin(), aid.trials.end(),
              [](const TrialRecord* a, const TrialRecord* b) { return a->score.seed < b->score.seed; });
}

AidComparison compared(const AidTrials& unaided, const AidTrials& aided, const Measure& measure)
{
  AidComparison result{aided.aid, measure, {}, {}};
  std::vector<double> without, with;
  for (const TrialRecord* trial : aided.trials) {
    const TrialRecord* partner = unaided.ofSeed(trial->score.seed);
    if (partner == nullptr || !measure.of(partner->score) || !measure.of(trial->score)) continue;
    result.seeds.push_back(trial->score.seed);
    without.push_back(*measure.of(partner->score));
    with.push_back(*measure.of(trial->score));
  }
  result.figures = comparePairs(without, with);
  return result;
}

std::optional<double> secondsOfBurn(const TrialScore& score)
{
  if (!score.burns_per_s || !(*score.burns_per_s > 0.0)) return std::nullopt;
  return 1.0 / *score.burns_per_s;
}

}  // namespace

const TrialRecord* AidTrials::ofSeed(std::uint64_t seed) const
{
  const auto found =
      std::find_if(trials.begin(), trials.end(), [seed](const TrialRecord* t) { return t->score.seed == seed; });
  return found != trials.end() ? *found : nullptr;
}

const AidTrials* StudyGroup::unaided() const
{
  const auto found = std::find_if(aids.begin(), aids.end(), [](const AidTrials& t) { return isUnaided(t.aid); });
  return found != aids.end() ? &*found : nullptr;
}

std::vector<StudyGroup> groupsOf(const std::vector<TrialRecord>& records)
{
  std::vector<StudyGroup> groups;
  for (const TrialRecord& record : records) add(record, groupFor(record, groups));
  for (StudyGroup& group : groups) sort(group);
  return groups;
}

const std::vector<Measure>& measuresOf(const std::string& task)
{
  static const std::vector<Measure> kTip{
      {"RMS error", "um", [](const TrialScore& score) { return score.rms_um; }},
      {"95th percentile of error", "um", [](const TrialScore& score) { return score.p95_um; }}};
  static const std::vector<Measure> kBurns{
      {"mean placement error", "um", [](const TrialScore& score) { return score.placement_mean_um; }},
      {"95th percentile of placement error", "um", [](const TrialScore& score) { return score.placement_p95_um; }},
      {"time per burn", "s", secondsOfBurn}};
  return task == "laser" ? kBurns : kTip;
}

std::vector<AidComparison> comparisonsOf(const StudyGroup& group)
{
  std::vector<AidComparison> result;
  const AidTrials* unaided = group.unaided();
  if (unaided == nullptr) return result;
  for (const AidTrials& aided : group.aids) {
    if (isUnaided(aided.aid)) continue;
    for (const Measure& measure : measuresOf(group.task)) result.push_back(compared(*unaided, aided, measure));
  }
  return result;
}

std::vector<std::uint64_t> seedsMadeWorse(const std::vector<AidComparison>& comparisons, const std::string& aid)
{
  std::vector<std::uint64_t> seeds;
  std::size_t of_this_aid = 0;
  for (const AidComparison& comparison : comparisons) {
    if (comparison.aid != aid || of_this_aid++ >= kErrorMeasures) continue;
    for (std::size_t i = 0; i < comparison.seeds.size(); ++i)
      if (comparison.figures.worse[i]) seeds.push_back(comparison.seeds[i]);
  }
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  return seeds;
}

Examples examplesOf(const AidTrials& trials)
{
  std::vector<const TrialRecord*> judged;
  const auto error = [](const TrialRecord* trial) { return measuresOf(trial->task).front().of(trial->score); };
  for (const TrialRecord* trial : trials.trials)
    if (error(trial)) judged.push_back(trial);
  if (judged.empty()) return {};
  std::stable_sort(judged.begin(), judged.end(),
                   [&](const TrialRecord* a, const TrialRecord* b) { return *error(a) < *error(b); });
  return {judged[(judged.size() - 1) / 2], judged.back()};
}

}  // namespace eyeslam::trials
