// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/trials/scenario.h"
#include "trial/trial_arguments.h"

namespace eyeslam::apps {

/// One trial of a study, before it is run.
struct PlannedTrial {
  const trials::Variant* variant = nullptr;
  std::uint64_t seed = 0;
  std::string folder;      ///< below the study's: SCENARIO/VARIANT/seed_NNNN
  std::string place;       ///< equal where TrialScene is
  double longest_s = 0.0;  ///< that it may last, simulated
};

/// The trials of a call in their order: by scenario, by seed, by variant, so that those of one place follow each other.
class TrialList {
 public:
  /// @throws configuration::ConfigurationError a scenario that cannot be read
  explicit TrialList(const TrialArguments& arguments);
  TrialList(const TrialList&) = delete;
  TrialList& operator=(const TrialList&) = delete;

  const std::vector<PlannedTrial>& trials() const { return trials_; }

 private:
  std::vector<std::vector<trials::Variant>> scenarios_;
  std::vector<PlannedTrial> trials_;
};

/// "vessel_tracing, aid=hard, seed 3"
std::string nameOf(const PlannedTrial& trial);

}  // namespace eyeslam::apps
