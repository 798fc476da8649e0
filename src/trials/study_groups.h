// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/trials/bootstrap.h"
#include "eyeslam/trials/trial_record.h"

namespace eyeslam::trials {

/// The trials of one aid, by seed, each seed once.
struct AidTrials {
  std::string aid;
  std::vector<const TrialRecord*> trials;

  /// Null: that seed was not run.
  const TrialRecord* ofSeed(std::uint64_t seed) const;
};

/// Trials that differ in nothing but aid and seed.
struct StudyGroup {
  std::string scenario, task;
  std::string variant;          ///< swept values other than the aid; may be empty
  std::vector<AidTrials> aids;  ///< the unaided first, the strongest last

  /// Null: every trial had an aid.
  const AidTrials* unaided() const;
};

/// In the order in which they first appear. The records must outlive the groups.
std::vector<StudyGroup> groupsOf(const std::vector<TrialRecord>& records);

/// A figure of a trial, of which less is better.
struct Measure {
  std::string name, unit;
  std::optional<double> (*of)(const TrialScore& score);
};

/// What trials of a task are judged by, the most important first: of a tip RMS and 95th percentile of its error; of
/// burns mean and 95th percentile of placement, and the time of a burn.
const std::vector<Measure>& measuresOf(const std::string& task);

/// What an aid changes in one measure, over the seeds that were run with it and without.
struct AidComparison {
  std::string aid;
  Measure measure;
  std::vector<std::uint64_t> seeds;
  PairedComparison figures;
};

/// Each aid against the unaided, by each measure; none where nothing is unaided.
std::vector<AidComparison> comparisonsOf(const StudyGroup& group);

/// Seeds in which an aid is worse by RMS or 95th percentile of the error; of burns by those of placement.
std::vector<std::uint64_t> seedsMadeWorse(const std::vector<AidComparison>& comparisons, const std::string& aid);

/// The trial in the middle, and the last, when sorted by their first measure; of those that have it.
struct Examples {
  const TrialRecord* median = nullptr;
  const TrialRecord* worst = nullptr;
};
Examples examplesOf(const AidTrials& trials);

}  // namespace eyeslam::trials
