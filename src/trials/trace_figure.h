// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/trial_record.h"

namespace eyeslam::trials {

/// The way of the tip over the true retina, as in Fig. 7 of the EyeSLAM paper: trials side by side in one frame and
/// scale, below them a close-up of the same place in each. One trial: the close-up beside it.
/// @param trials  of one seed, 1 to 3, the unaided first; @param name  unlike any other figure's on the page
std::string traceFigure(const std::vector<const TrialRecord*>& trials, const std::string& name);

}  // namespace eyeslam::trials
