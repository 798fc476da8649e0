// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace eyeslam::apps {

/// What a detector finds of a sequence's labelled vessels, mean over the frames looked at; fractions in [0, 1].
struct DetectorScore {
  double points = 0.0;              ///< a frame
  double on_vessel = 0.0;           ///< share of the points within 4 full px of a labelled vessel
  double coverage = 0.0;            ///< share of the centrelines in view with a point within 4 full px
  double coverage_from_6_px = 0.0;  ///< the same of vessels at least 6 full px wide
  double cpu_us = 0.0;              ///< median of detection alone; the frame is already normalised
};

/// Names of what is compared: `ridge`, `tracing`, and `paper` (tracing, culled and smoothed across the vessel).
std::vector<std::string> detectorNames();

/// Runs a detector over every `period`-th visible frame of a sequence (contracts, section 5).
/// @throws files::FileError, std::invalid_argument when the sequence has no vessel picture
DetectorScore scoreDetector(const std::string& detector, const std::string& sequence, int period);

}  // namespace eyeslam::apps
