// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/files/map_reader.h"
#include "eyeslam/fixtures/burn_plan.h"

namespace eyeslam::files {

/// A plan as `plan.json` (contracts, section 6); numbers in the shortest form that reads back to the same value.
std::string planJson(const fixtures::BurnPlan& plan);

/// A plan from the text of a `plan.json`, every field checked.
/// @param path  only for messages
/// @throws FileError naming the file and the field ("targets[3].x_px"): truncated, of another kind or version, missing
///         or unknown, no number, negative where it must not be, ids that stand twice, a valid target after a refused
fixtures::BurnPlan planFrom(const std::string& text, const std::string& path);

/// Reads or writes the file; the writing is atomic. @throws FileError
fixtures::BurnPlan readPlan(const std::string& path);
void writePlan(const fixtures::BurnPlan& plan, const std::string& path);

/// @throws FileError when plan and map are known to come from different videos, naming both
void checkSameTrack(const fixtures::BurnPlan& plan, const std::string& plan_path, const RecordedMap& map);

}  // namespace eyeslam::files
