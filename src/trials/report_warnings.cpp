// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/report_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "eyeslam/trials/aid_style.h"

namespace eyeslam::trials {

namespace {

using Warnings = std::vector<std::string>;

constexpr std::size_t kEventsNamed = 6, kTrialsNamed = 60;
constexpr double kMostLeftOut = 0.1;    // of the frames
constexpr double kThickVessel = 50e-6;  // m, that no burn may touch; issue 17

std::string counted(std::int64_t count, const std::string& thing)
{
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

// Where a bare hand's pulses go says nothing against the system; figures tell it.
void warnOfPlaces(const TrialRecord& record, Warnings& warnings)
{
  if (isUnaided(record.score.aid)) return;
  if (record.score.far_unexplained.value_or(0) > 0)
    warnings.push_back(counted(*record.score.far_unexplained, "pulse") +
                       " more than 60 um off that no motion of the retina explains");
  const auto touching = std::count_if(record.pulses.begin(), record.pulses.end(),
                                      [](const PulseRecord& pulse) { return pulse.touched_calibre >= kThickVessel; });
  if (touching > 0) warnings.push_back(counted(touching, "burn") + " on a true vessel of 50 um or more");
}

void warnOfPulses(const TrialRecord& record, Warnings& warnings)
{
  const TrialScore& score = record.score;
  if (score.interlock_violations.value_or(0) > 0)
    warnings.push_back(counted(*score.interlock_violations, "pulse") + " while an interlock was open");
  warnOfPlaces(record, warnings);
  if (isUnaided(score.aid)) return;  // a hand takes its time
  const auto open = std::count_if(record.targets.begin(), record.targets.end(),
                                  [](const PlannedTarget& target) { return target.fate == "pending"; });
  if (open > 0) warnings.push_back(counted(open, "target") + " not reached in the time");
}

void warnOfEvents(const TrialRecord& record, Warnings& warnings)
{
  if (record.passed.value_or(false)) return;  // they had to happen
  const TrialScore& score = record.score;
  if (score.fault_events > 0) warnings.push_back("went into fault " + counted(score.fault_events, "time"));
  if (score.hold_events > 0) warnings.push_back("went into hold " + counted(score.hold_events, "time"));
  std::size_t named = 0;
  for (const TrialEvent& event : record.events) {
    if (!event.warning || named++ >= kEventsNamed) continue;
    warnings.push_back(
        fmt::format("at {:.2f} s: {}{}", event.t_s, event.what, event.reason.empty() ? "" : " (" + event.reason + ")"));
  }
  if (named > kEventsNamed)
    warnings.push_back(fmt::format("and {} more events of this kind, in the table of events", named - kEventsNamed));
}

void warnOfGaps(const TrialRecord& record, Warnings& warnings)
{
  if (record.left_out > kMostLeftOut)
    warnings.push_back(fmt::format(
        "the tracker had no time for {:.0f} % of the frames: give a trial in real time two idle cores, or leave "
        "--real-time out",
        100.0 * record.left_out));
  const auto missing = [&](bool is, const char* what) {
    if (is) warnings.push_back(fmt::format("missing: {}", what));
  };
  const bool laser = record.task == "laser";
  missing(!laser && record.tip.empty(), "the way of the tip");
  missing(!laser && !record.score.rms_um, "errors of the tip");
  missing(record.task == "trace" && record.path.empty(), "the path that was to be traced");
  missing(laser && record.targets.empty(), "a plan in force");
  missing(laser && record.pulses.empty(), "pulses: none was emitted");
  missing(record.retina.bgr.empty(), "the picture of the retina");
  // Without an aid nobody looks through the camera.
  const bool seen = !isUnaided(record.score.aid);
  missing(seen && record.pose_errors_px.empty(), "poses of the retina");
  const bool followed = seen && record.score.aid != "filter";  // which tells tremor without any camera
  missing(followed && record.frame_to_command_s.empty(), "commands that follow a frame");
}

std::string listed(const std::vector<std::uint64_t>& seeds)
{
  std::string text;
  for (const std::uint64_t seed : seeds) text += (text.empty() ? "" : ", ") + std::to_string(seed);
  return (seeds.size() == 1 ? "seed " : "seeds ") + text;
}

std::string nameOf(const StudyGroup& group)
{
  return group.scenario + (group.variant.empty() ? "" : ", " + group.variant);
}

void warnOfAids(const StudyGroup& group, Warnings& warnings)
{
  const std::vector<AidComparison> comparisons = comparisonsOf(group);
  for (const AidTrials& aid : group.aids) {
    const std::vector<std::uint64_t> worse = seedsMadeWorse(comparisons, aid.aid);
    if (!worse.empty())
      warnings.push_back(
          fmt::format("{}: worse with aid {} than without it in {}", nameOf(group), aid.aid, listed(worse)));
  }
}

void warnOfPairs(const StudyGroup& group, Warnings& warnings)
{
  const AidTrials* unaided = group.unaided();
  if (unaided == nullptr) return;
  for (const AidTrials& aid : group.aids) {
    std::vector<std::uint64_t> alone;
    for (const TrialRecord* trial : aid.trials)
      if (unaided->ofSeed(trial->score.seed) == nullptr) alone.push_back(trial->score.seed);
    for (const TrialRecord* trial : unaided->trials)
      if (aid.ofSeed(trial->score.seed) == nullptr) alone.push_back(trial->score.seed);
    if (!alone.empty())
      warnings.push_back(fmt::format("{}: not compared, because only one of aid {} and {} was run: {}", nameOf(group),
                                     unaided->aid, aid.aid, listed(alone)));
  }
}

}  // namespace

std::string nameOf(const TrialRecord& record)
{
  return fmt::format("{}{}, seed {}", record.score.scenario, record.variant.empty() ? "" : ", " + record.variant,
                     record.score.seed);
}

std::vector<std::string> warningsOf(const TrialRecord& record)
{
  Warnings warnings;
  if (!record.whole) warnings.emplace_back(kCutOff);
  if (record.passed && !*record.passed) warnings.push_back("failed: " + record.verdict);
  warnOfPulses(record, warnings);
  warnOfEvents(record, warnings);
  warnOfGaps(record, warnings);
  return warnings;
}

std::vector<std::string> warningsOf(const std::vector<TrialRecord>& records, const std::vector<StudyGroup>& groups)
{
  Warnings warnings, of_trials;
  std::set<std::string> versions;
  std::size_t kept = 0;
  for (const TrialRecord& record : records) {
    versions.insert(record.score.version);
    for (const std::string& warning : warningsOf(record)) of_trials.push_back(nameOf(record) + ": " + warning);
  }
  for (const StudyGroup& group : groups) {
    warnOfAids(group, warnings);
    warnOfPairs(group, warnings);
    for (const AidTrials& aid : group.aids) kept += aid.trials.size();
  }
  if (kept < records.size())
    warnings.push_back(fmt::format("{} trials were given twice; the first of each counts", records.size() - kept));
  if (versions.size() > 1) warnings.push_back(fmt::format("the trials come from {} versions", versions.size()));
  // Failed verdicts before all else.
  std::stable_partition(of_trials.begin(), of_trials.end(),
                        [](const std::string& text) { return text.find(": failed: ") != std::string::npos; });
  const std::size_t named = std::min(of_trials.size(), kTrialsNamed);
  warnings.insert(warnings.begin(), of_trials.begin(), of_trials.begin() + static_cast<std::ptrdiff_t>(named));
  if (named < of_trials.size())
    warnings.push_back(fmt::format("and {} more, in the table of trials", of_trials.size() - named));
  return warnings;
}

}  // namespace eyeslam::trials
