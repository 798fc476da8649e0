// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <string>

#include "link/program_link.h"

namespace eyeslam::apps {

/// The command line of `eyeslam-view`.
struct ViewArguments {
  LinkArguments link;
  std::string size = "800x608";  ///< of the image
  bool console = false;
  bool quiet = false;
};

void addOptions(CLI::App& app, ViewArguments& arguments);

/// The image's centre, px. @throws UsageError
Eigen::Vector2d centreOf(const ViewArguments& arguments);

}  // namespace eyeslam::apps
