// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/trial_record.h"

namespace eyeslam::trials {

/// How old what the servo acts on is, over all frames of all trials: age of a pose when it arrives, mid-exposure to the
/// first command that uses it; in real time the CPU time of cycles as well. Empty where there are none.
std::string latencyFigure(const std::vector<const TrialRecord*>& trials);

}  // namespace eyeslam::trials
