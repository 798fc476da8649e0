// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "replay/replay_arguments.h"

namespace eyeslam::apps {

/// `eyeslam-replay LOG --csv DIR`.
/// @throws std::runtime_error at the end, with everything else written, when a channel's type is not today's
void writeTables(const ReplayArguments& arguments);

}  // namespace eyeslam::apps
