// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/report_page.h"
#include "eyeslam/trials/trial_record.h"

namespace eyeslam::trials {

/// The pictures of trials of one seed beside each other: the way of the tip and its error over time, or the burns.
/// @param trials  1 to 3, the unaided first; @param name  unlike any other on the page
void addPictures(const std::vector<const TrialRecord*>& trials, const std::string& name, ReportPage& page);

/// Latencies of all these trials.
void addLatencies(const std::vector<const TrialRecord*>& trials, ReportPage& page);

}  // namespace eyeslam::trials
