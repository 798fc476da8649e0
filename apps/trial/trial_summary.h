// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/trial_record.h"

namespace eyeslam::apps {

/// What a terminal shows of a study: warnings, figures of each aid over the seeds, what an aid changes.
std::string summaryOf(const std::vector<trials::TrialRecord>& records);

/// Trials that speak against the system: a failed verdict, a pulse with an interlock open.
std::size_t failuresAmong(const std::vector<trials::TrialRecord>& records);

}  // namespace eyeslam::apps
