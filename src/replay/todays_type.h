// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/replay/message_types.h"

namespace eyeslam::replay {

/// judge() for whom a message of another version is the end, and not something to be left out.
/// @throws ReplayError  naming channel, type and the migration that exists
JudgedEvent judgeToday(const files::LogEvent& event);

}  // namespace eyeslam::replay
