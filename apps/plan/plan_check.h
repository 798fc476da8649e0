// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "plan/plan_arguments.h"

namespace eyeslam::apps {

/// Validates the plan of `--check` on the map of the folder and says what changed; writes what is asked for.
/// @throws std::runtime_error naming the targets that became invalid, after all is written
void checkPlan(const PlanArguments& arguments);

}  // namespace eyeslam::apps
