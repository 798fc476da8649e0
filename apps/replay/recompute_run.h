// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "replay/replay_arguments.h"

namespace eyeslam::apps {

/// `eyeslam-replay LOG`: computes again what its parts had sent, and compares.
/// @throws std::runtime_error at the end when anything differs, or the log lacks what is needed
void recomputeLog(const ReplayArguments& arguments);

}  // namespace eyeslam::apps
