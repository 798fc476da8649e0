// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/fixtures/burn_prescription.h"

namespace eyeslam::apps {

/// The command line of `eyeslam-plan` (contracts, section 2).
struct PlanArguments {
  std::string folder;                   ///< what eyeslam-track wrote
  std::string out;                      ///< of the plan; empty = folder/plan.json, or none with `check`
  std::string prescription;             ///< YAML file, or empty
  std::vector<std::string> settings;    ///< "group.key=value"
  std::vector<std::string> shorthands;  ///< the same, from options with names of their own
  std::optional<double> um_per_px;
  std::optional<std::int64_t> frame;  ///< whose map; nothing = the newest
  std::string svg;                    ///< drawings, or empty
  std::string png;
  std::string over = "map";  ///< what they lie over: "map", "mosaic", or a picture
  std::string check;         ///< a plan to validate again, or empty
  std::string dump;          ///< "yaml", "markdown", or empty
  bool travel = false;       ///< draw the way from burn to burn
  bool quiet = false;
};

/// Ties the options of the command line to the struct.
void addOptions(CLI::App& app, PlanArguments& arguments);

/// @throws UsageError naming the first option that makes no sense with the others
void check(const PlanArguments& arguments);

/// Defaults, then `--prescription`, then `--set`, then the options with names of their own.
/// @throws configuration::ConfigurationError
fixtures::BurnPrescription prescriptionOf(const PlanArguments& arguments);

/// Where the plan goes; empty = nowhere.
std::string planPath(const PlanArguments& arguments);

}  // namespace eyeslam::apps
