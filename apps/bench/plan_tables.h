// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace eyeslam::apps {

/// What burn plans are judged on.
struct PlanInputs {
  std::vector<std::string> sequences;  ///< folders with truth
  std::string tracks;                  ///< folder with what eyeslam-track wrote of each, under the sequence's name
  std::string photographs;             ///< folder with NAME.jpg and NAME_vessels.png, or empty
  double um_per_px = 4.0;              ///< of the photographs
  bool quiet = false;
};

/// Prints as Markdown: how many planned burns come nearer to a vessel of their map than they may, and how many touch a
/// true vessel that the map does not have. @throws files::FileError, fixtures::PlanError
void printPlanTables(const PlanInputs& inputs);

}  // namespace eyeslam::apps
