// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/report_page.h"
#include "eyeslam/trials/study_groups.h"
#include "eyeslam/trials/trial_record.h"

namespace eyeslam::trials {

/// What is said of a trial first.
std::vector<Headline> headlinesOf(const TrialRecord& record);
/// Every score of a trial that applies, with its name in results.csv.
ReportTable scoreTable(const TrialScore& score);
ReportTable eventTable(const std::vector<TrialEvent>& events);
ReportTable pulseTable(const std::vector<PulseRecord>& pulses);
/// What became of the targets, by reason.
ReportTable targetTable(const TrialRecord& record);

/// Mean and spread over seeds, a row an aid.
ReportTable aidTable(const StudyGroup& group);
/// The same of localization, reach and the servo's states.
ReportTable loopTable(const StudyGroup& group);
/// What each aid changes, with 95 % intervals.
ReportTable comparisonTable(const std::vector<AidComparison>& comparisons);
/// A row a trial.
ReportTable trialTable(const StudyGroup& group);
/// Burns that touch a true vessel, by its calibre.
ReportTable touchTable(const StudyGroup& group);
/// Beside what was published by others; empty where nothing of the kind was.
ReportTable publishedTable(const StudyGroup& group, const std::vector<AidComparison>& comparisons);

/// "92.1 % (90.8 to 93.2)"; of one pair without an interval, which needs two.
std::string reductionOf(const PairedComparison& figures);
/// What had to happen, and what did; of trials that say so.
ReportTable verdictTable(const StudyGroup& group);

}  // namespace eyeslam::trials
