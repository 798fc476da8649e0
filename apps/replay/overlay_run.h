// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "replay/replay_arguments.h"

namespace eyeslam::apps {

/// `eyeslam-replay overlay LOG --out FILE`: the video beside a log with everything drawn that the log tells of.
void drawLog(const ReplayArguments& arguments);

}  // namespace eyeslam::apps
