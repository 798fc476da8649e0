// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/trial_record.h"

namespace eyeslam::trials {

/// Burns over the true retina, as in Fig. 8 of the EyeSLAM paper: targets, burns where they truly went and in true
/// size, vessels with the margin that targets keep, what was refused and missed with its reason. Trials side by side.
/// @param trials  of one seed, 1 or 2, the manual one first
/// @param margin  m, 0: not known; @param name  unlike any other figure's on the page
std::string burnFigure(const std::vector<const TrialRecord*>& trials, double margin, const std::string& name);

/// Each burn as seen from its target, um: one panel an aid, all its trials.
std::string placementFigure(const std::vector<std::vector<const TrialRecord*>>& aids);

}  // namespace eyeslam::trials
