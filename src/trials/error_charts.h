// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/study_groups.h"
#include "eyeslam/trials/trial_record.h"

namespace eyeslam::trials {

/// The tip's error over time: each column from its least to its greatest, so that no peak is lost, and its RMS over
/// half a second; fast motion of the retina shaded; what happened marked. Several trials in one scale, and the last one
/// again in its own.
/// @param trials  of one seed, the unaided first
std::string errorOverTime(const std::vector<const TrialRecord*>& trials);

/// Which share of errors is smaller than each size: thick over all seeds, thin of each. Of laser trials the placement.
std::string errorDistribution(const std::vector<AidTrials>& aids);

/// A dot a trial, what has one seed joined; beside them the mean with its 95 % interval. A panel a measure.
std::string overSeedsFigure(const StudyGroup& group);

}  // namespace eyeslam::trials
