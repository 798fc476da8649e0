// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "eyeslam/files/map_score.h"
#include "eyeslam/files/score.h"
#include "eyeslam/files/truth.h"

namespace eyeslam::files {

/// A map judged at one frame, as the figure shows it.
struct JudgedMap {
  MapScore score;
  cv::Mat_<std::uint8_t> verdicts;  ///< of MapScorer after that score (a copy, for it changes with the next one)
};

/// Pose and error over time, as in the paper's Fig. 4: x, y and theta estimated and true on the left, the errors on the
/// right, frames in which the retina was hidden shaded. Half-resolution px and deg, as the score counts.
/// @return BGR, 8 bit, 1600 x 1000
/// @throws std::invalid_argument as scorePoses does
cv::Mat poseFigure(const std::string& name, const Truth& truth, const std::vector<EstimatedPose>& estimate);

/// Coverage and false positives over time, and the map at up to four times in the colours of true, false and missed, as
/// in the paper's Fig. 6; the paper's own figures (human retina) stand in it as squares.
/// @param maps  in the order of their frames, at least one
/// @return BGR, 8 bit, 1600 x 1000
/// @throws std::invalid_argument without a map
cv::Mat mapFigure(const std::string& name, const Truth& truth, const std::vector<JudgedMap>& maps);

}  // namespace eyeslam::files
