// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "track/track_configuration.h"

namespace eyeslam::apps {

/// The command line of `eyeslam-track` (contracts, section 2).
struct TrackArguments {
  std::string input;
  std::string out;
  std::string method = "eyeslam";
  std::string config;                 ///< YAML file, or empty
  std::vector<std::string> settings;  ///< "group.key=value"
  std::optional<std::string> scale;
  std::optional<std::string> seed;
  std::int64_t from = 0;
  std::int64_t to = -1;  ///< last frame, -1 = all
  std::vector<std::int64_t> snapshots;
  std::optional<double> um_per_px;
  double fps = 30.0;               ///< of images
  double timeout = 5.0;            ///< s without a frame in shared memory until it counts as ended
  std::string record;              ///< lossless video of the processed frames, or empty
  std::string truth;               ///< folder with a sequence's truth, or empty
  std::optional<std::string> lcm;  ///< URL of LCM; empty = LCM_DEFAULT_URL
  std::string key;                 ///< file with the key that signs messages, or empty
  std::string dump;                ///< "yaml", "markdown", or empty
  bool no_overlay = false;
  bool display = false;
  bool quiet = false;
};

/// Ties the options of the command line to the struct.
void addOptions(CLI::App& app, TrackArguments& arguments);

/// @throws UsageError naming the first option that makes no sense with the others
void check(const TrackArguments& arguments);

/// All options: defaults, then `--config`, then `--set`, then `--scale` and `--seed`.
/// @throws ConfigurationError
TrackConfiguration configurationOf(const TrackArguments& arguments);

}  // namespace eyeslam::apps
