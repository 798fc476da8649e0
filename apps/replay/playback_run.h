// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "replay/replay_arguments.h"

namespace eyeslam::apps {

/// `eyeslam-replay LOG --lcm URL`: sends each event's bytes as they are, at its time; none is left out.
/// @throws std::runtime_error at the end when LCM refused any
void playLog(const ReplayArguments& arguments);

}  // namespace eyeslam::apps
