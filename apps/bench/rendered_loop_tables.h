// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bench/loop_tables.h"

namespace eyeslam::apps {

/// Prints as Markdown what the whole chain reaches in lock step: rendered frames, the real tracker, a calibration of
/// its own, servo and simulated hardware, over messages; beside the loop study, whose tracker was assumed, and the
/// bounds of issue 16. um.
void printRenderedLoopTables(const LoopInputs& inputs);

}  // namespace eyeslam::apps
