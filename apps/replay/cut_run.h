// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "replay/replay_arguments.h"

namespace eyeslam::apps {

/// `eyeslam-replay cut LOG --out FILE`: the events of a part, by time, each with its own time.
void cutLog(const ReplayArguments& arguments);

}  // namespace eyeslam::apps
