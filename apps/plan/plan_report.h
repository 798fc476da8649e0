// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/fixtures/burn_plan.h"

namespace eyeslam::apps {

/// What a surgeon must know before the rest: what is unknown, what could not be placed. A line each, begins with
/// "warning: ", may be empty.
std::string warningsOf(const fixtures::BurnPlan& plan);

/// Counts, refusals by reason, dose, density, coverage, clearance, travel, placements, rest; a line each.
std::string summaryOf(const fixtures::BurnPlan& plan);

}  // namespace eyeslam::apps
