// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/configuration/assignment.h"

namespace eyeslam::apps {

/// The command line of `eyeslam-trial` (contracts, sections 2 and 7).
struct TrialArguments {
  std::vector<std::string> scenarios;  ///< files
  std::string out;                     ///< folder of the results
  std::optional<std::int64_t> seeds;   ///< 0 to seeds - 1
  std::optional<std::int64_t> seed;    ///< this alone; without both: 0
  int jobs = 0;                        ///< trials at a time; 0 = as many as there are cores
  std::string shard = "1/1";
  bool real_time = false;  ///< with the real programs beside it, one trial after the other
  bool video = false, no_logs = false, quiet = false;
  std::vector<std::string> settings;  ///< "group.key=value"
  std::string dump;                   ///< "yaml", "markdown", or empty
};

/// The part of a study that one computer runs, of `count` in all; from 1.
struct Shard {
  std::size_t number = 1, count = 1;
};

/// Ties the options of the command line to the struct.
void addOptions(CLI::App& app, TrialArguments& arguments);

/// @throws UsageError naming the first option that makes no sense with the others
void check(const TrialArguments& arguments);

/// @throws UsageError where the text is no I/N with 1 <= I <= N
Shard shardOf(const TrialArguments& arguments);

/// @throws configuration::ConfigurationError
std::vector<configuration::Assignment> settingsOf(const TrialArguments& arguments);

std::vector<std::uint64_t> seedsOf(const TrialArguments& arguments);

}  // namespace eyeslam::apps
