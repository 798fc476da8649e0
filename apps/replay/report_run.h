// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "replay/replay_arguments.h"

namespace eyeslam::apps {

/// `eyeslam-replay report LOG --out DIR`: results.json, results.csv and report.html as `eyeslam-trial` wrote them.
void reportLog(const ReplayArguments& arguments);

}  // namespace eyeslam::apps
