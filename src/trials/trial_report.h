// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/trial_record.h"

namespace eyeslam::trials {

/// report.html of one trial: warnings first, figures, what happened, the configuration; one file that needs nothing
/// else, no network and no script.
std::string trialReport(const TrialRecord& record);

/// report.html of a study over seeds and swept values: trials that differ in nothing but aid and seed are compared in
/// pairs; the median and the worst seed are shown, the others stand in tables. Pictures of the retina are what makes
/// it large: some 0.7 MB a scenario. Of no records: a page that says so.
/// @param missing  trials of the study that are not among the records, and why; the first warnings
std::string studyReport(const std::vector<TrialRecord>& records, const std::vector<std::string>& missing = {});

}  // namespace eyeslam::trials
