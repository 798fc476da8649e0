// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command_line/progress.h"
#include "eyeslam/configuration/assignment.h"
#include "eyeslam/replay/log_selection.h"
#include "link/program_link.h"

namespace eyeslam::apps {

/// The command line of `eyeslam-replay` (contracts, section 2).
struct ReplayArguments {
  std::string log;
  replay::LogPart part;
  std::string csv;     ///< folder of tables, or empty
  bool plays = false;  ///< onto `link`
  LinkArguments link;
  double speed = 1.0;
  std::string video;                  ///< beside the log; empty: `video.mkv` in its folder, where there is one
  std::optional<double> offset;       ///< s, of the video's clock
  std::string only;                   ///< "tracker", "servo", or empty: what can be computed again
  std::string config;                 ///< YAML of what shall be otherwise than it was, or empty
  std::vector<std::string> settings;  ///< the same, "group.key=value"
  std::string out;                    ///< of cut and report
  std::string json;                   ///< of info and of computing again, or empty
  bool quiet = false;

  Verbosity verbosity() const { return quiet ? Verbosity::quiet : Verbosity::normal; }
};

/// The commands besides `eyeslam-replay LOG` itself.
struct ReplayCommands {
  CLI::App* info = nullptr;
  CLI::App* cut = nullptr;
  CLI::App* report = nullptr;
  CLI::App* overlay = nullptr;
};

/// Ties the options of the command line to the struct.
ReplayCommands addOptions(CLI::App& app, ReplayArguments& arguments);

/// What shall be otherwise than it was: `--config`, then `--set`. @throws configuration::ConfigurationError
std::vector<configuration::Assignment> changesOf(const ReplayArguments& arguments);

/// The part of the log that was asked for. @throws UsageError naming the option that makes no sense
replay::LogSelection selectionOf(const ReplayArguments& arguments);

/// @throws UsageError naming the first option that makes no sense with the others
void check(const ReplayArguments& arguments);

}  // namespace eyeslam::apps
