// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "command_line/progress.h"
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
  std::string out;   ///< of cut
  std::string json;  ///< of info, or empty
  bool quiet = false;

  Verbosity verbosity() const { return quiet ? Verbosity::quiet : Verbosity::normal; }
};

/// The commands besides `eyeslam-replay LOG` itself.
struct ReplayCommands {
  CLI::App* info = nullptr;
  CLI::App* cut = nullptr;
};

/// Ties the options of the command line to the struct.
ReplayCommands addOptions(CLI::App& app, ReplayArguments& arguments);

/// The part of the log that was asked for. @throws UsageError naming the option that makes no sense
replay::LogSelection selectionOf(const ReplayArguments& arguments);

/// @throws UsageError naming the first option that makes no sense with the others
void check(const ReplayArguments& arguments);

}  // namespace eyeslam::apps
