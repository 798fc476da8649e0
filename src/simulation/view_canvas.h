// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "eyeslam/simulation/condition.h"
#include "eyeslam/simulation/fundus.h"

namespace eyeslam::simulation {

/// A fundus as a condition shows it, `zoom` times as large.
Fundus preparedFundus(const Fundus& fundus, const TissueOptions& tissue, double zoom);

/// What a microscope paints from: a part of a fundus, CV_32FC4, white = 1.
cv::Mat canvasOf(const Fundus& fundus, cv::Rect area);

}  // namespace eyeslam::simulation
