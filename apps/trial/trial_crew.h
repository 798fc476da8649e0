// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "command_line/interruption.h"
#include "eyeslam/trials/trial_record.h"
#include "trial/shared_scenes.h"
#include "trial/trial_arguments.h"
#include "trial/trial_list.h"

namespace eyeslam::apps {

/// What became of a list of trials.
struct TrialOutcomes {
  std::vector<trials::TrialRecord> records;  ///< of those that ran to their end, in the order of the list
  std::vector<std::string> failures;         ///< a line each: name and cause
  bool interrupted = false;
};

/// Runs a list of trials, several at a time, a thread each; shows the progress.
class TrialCrew {
 public:
  /// @param list  must outlive it, as must the others
  TrialCrew(const TrialList& list, const TrialArguments& arguments, Interruption& interruption);

  TrialOutcomes run();

 private:
  void work();
  void runOne(std::size_t index);
  void watch();
  TrialOutcomes outcomes();

  const std::vector<PlannedTrial>& trials_;
  const TrialArguments& arguments_;
  Interruption& interruption_;
  SharedScenes scenes_;
  std::mutex folders_;
  std::vector<std::optional<trials::TrialRecord>> records_;  // each written by one thread
  std::vector<std::string> failures_;
  std::vector<std::atomic<double>> done_s_;
  std::atomic<std::size_t> next_{0}, workers_{0};
  std::atomic<bool> stopped_{false};
};

}  // namespace eyeslam::apps
