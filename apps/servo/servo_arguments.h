// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "eyeslam/servo/servo_configuration.h"
#include "link/program_link.h"

namespace eyeslam::apps {

/// The command line of `eyeslam-servo` (contracts, section 2).
struct ServoArguments {
  LinkArguments link;
  std::string config;                 ///< YAML file, or empty
  std::vector<std::string> settings;  ///< "group.key=value"
  std::string registration;           ///< file of the camera's registration, or empty
  std::string timing;                 ///< CSV of every cycle, or empty
  std::string dump;                   ///< "yaml", "markdown", or empty
  bool quiet = false;
};

void addOptions(CLI::App& app, ServoArguments& arguments);

/// All options: defaults, then `--config`, then `--set`. @throws ConfigurationError
servo::ServoConfiguration configurationOf(const ServoArguments& arguments);

/// Prints the options. @throws UsageError
void dump(const ServoArguments& arguments);

}  // namespace eyeslam::apps
