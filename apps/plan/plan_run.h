// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/files/map_reader.h"
#include "eyeslam/fixtures/burn_plan.h"
#include "plan/plan_arguments.h"

namespace eyeslam::apps {

/// The map of the folder, with the scale that the call or its file gives (contracts, section 1).
files::RecordedMap mapOf(const PlanArguments& arguments);

/// Plans, writes plan and drawings, prints the summary.
void makePlan(const PlanArguments& arguments);

/// Writes the plan to `planPath` and the drawings that are asked for: all, or by exception none.
void writeResults(const PlanArguments& arguments, const fixtures::BurnPlan& plan, const files::RecordedMap& map);

}  // namespace eyeslam::apps
