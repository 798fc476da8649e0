// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "replay/replay_arguments.h"

namespace eyeslam::apps {

/// `eyeslam-replay info LOG`.
void showLog(const ReplayArguments& arguments);

}  // namespace eyeslam::apps
