// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/configuration/assignment.h"
#include "eyeslam/fixtures/burn_prescription.h"

namespace eyeslam::files {

/// A prescription from YAML (groups `pattern`, `laser`, `safety`, `keep_out`) and `--set group.key=value`, the latter
/// over the former. Lists may be YAML lists: `points_px: [[10, 20], [30, 40]]`.
/// @param path      of the YAML file, or empty for the defaults
/// @param settings  "group.key=value"
/// @throws configuration::ConfigurationError naming file or option, and the key: unknown, twice, of the wrong type, out
///         of range, or what `fixtures::check` finds
fixtures::BurnPrescription readPrescription(const std::string& path, const std::vector<std::string>& settings);

/// The prescription as YAML that `readPrescription` reads back, each key explained.
std::string prescriptionYaml(const fixtures::BurnPrescription& prescription);

}  // namespace eyeslam::files
