// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/study_groups.h"
#include "eyeslam/trials/trial_record.h"

namespace eyeslam::trials {

/// Of a trial that is judged by a log without its end.
constexpr const char* kCutOff = "the log ends before the trial does (no MARK STOP); what there is was judged";

/// What must be known before any figure of a trial is believed, the gravest first: a log that was cut off, a failed
/// verdict, pulses with an interlock open, far pulses that nothing explains, burns on a vessel, times in hold or fault,
/// what is missing.
std::vector<std::string> warningsOf(const TrialRecord& record);

/// Of all trials of a study, and what only a study shows: seeds in which an aid makes it worse, seeds without their
/// partner, trials that came twice, more than one version.
std::vector<std::string> warningsOf(const std::vector<TrialRecord>& records, const std::vector<StudyGroup>& groups);

/// "vessel_tracing, aid=hard, seed 3"
std::string nameOf(const TrialRecord& record);

}  // namespace eyeslam::trials
