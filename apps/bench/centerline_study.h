// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/files/centerline_score.h"

namespace eyeslam::apps {

/// The vessel graph of a hand-drawn mask against the mask's own lines, within 2 px. A mask's px is a map px.
/// @throws files::FileError naming the picture
files::CenterlineScore scoreMask(const std::string& mask);

/// The vessel graph of the newest map that `eyeslam-track` wrote for a sequence, against the labelled vessels that the
/// map covers, within 4 px (as maps are judged).
/// @param sequence  folder with the truth (contracts, section 5)
/// @param run       what `eyeslam-track` wrote
/// @throws files::FileError, std::invalid_argument when the sequence has no vessel picture
files::CenterlineScore scoreRun(const std::string& sequence, const std::string& run);

struct CenterlineInputs {
  std::vector<std::string> known;  ///< masks, or folders of sequences
  std::string tracks;              ///< of sequences: the folder that holds the runs, by the sequence's name
  bool quiet = false;
};

/// Prints a row for each and their mean. @throws UsageError, and as above
void printCenterlines(const CenterlineInputs& inputs);

}  // namespace eyeslam::apps
