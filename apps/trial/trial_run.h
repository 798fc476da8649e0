// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "trial/trial_arguments.h"

namespace eyeslam::apps {

/// Prints what `--dump-config` asks for.
void dumpConfiguration(const TrialArguments& arguments);

/// Runs all trials of a call, writes table and report, prints the summary.
/// @throws std::runtime_error at the end where a trial failed or could not run
void runTrials(const TrialArguments& arguments);

}  // namespace eyeslam::apps
