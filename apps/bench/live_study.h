// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace eyeslam::apps {

struct LiveInputs {
  double seconds = 20.0;  ///< that count
  std::string programs;   ///< folder with eyeslam-servo and eyeslam-track; empty: beside this program
  bool quiet = false;
};

/// Runs eyeslam-servo and eyeslam-track as processes over UDP against a simulated manipulator and frames that were
/// rendered before, beside a bare timer loop, and prints as Markdown how late cycles begin, which commands expire, what
/// a command costs, and how soon a frame moves the tip.
void printLiveTable(const LiveInputs& inputs);

}  // namespace eyeslam::apps
