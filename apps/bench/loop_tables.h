// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace eyeslam::apps {

/// How much of the loop study is run again.
struct LoopInputs {
  int seeds = 20;
  double seconds = 20.0;  ///< that count, of each seed
  bool rendered = false;  ///< on rendered frames with the real tracker; minutes instead of seconds
  bool quiet = false;
};

/// Prints as Markdown what the 1 kHz loop reaches in lock-step trials with assumed tracker noise, beside the loop study
/// and the bounds of issue 16: hold, parts left out, saccades, steps, tracing. um.
void printLoopTables(const LoopInputs& inputs);

}  // namespace eyeslam::apps
