// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/trial_score.h"

namespace eyeslam::trials {

/// The text of results.csv (contracts, section 7): the columns' names, then a row a trial. Comma separated; cells with
/// commas, quotes or line ends are quoted (RFC 4180).
std::string resultsTable(const std::vector<TrialScore>& scores);

/// Reads such a text, or several one after another: a repeated line of names is skipped.
/// @throws std::invalid_argument naming line and column
std::vector<TrialScore> parseResultsTable(const std::string& text);

/// Atomically. @throws files::FileError
void writeResultsTable(const std::string& path, const std::vector<TrialScore>& scores);

/// @throws files::FileError naming the file and, where it is no table of results, line and column
std::vector<TrialScore> readResultsTable(const std::string& path);

}  // namespace eyeslam::trials
