// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "eyeslam/files/truth.h"
#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::files {

/// How much of the vessels seen until a frame a map holds, and how much of what it holds is none. In [0, 1].
struct MapScore {
  int frame = 0;
  double coverage = 0.0;             ///< share of the vessels' centrelines with a map cell within 4 px
  double coverage_from_6_px = 0.0;   ///< the same of vessels at least 6 full px wide
  double coverage_from_10_px = 0.0;  ///< the same of vessels at least 10 full px wide
  double false_positive = 0.0;       ///< share of the map's px that lie over 4 px from any vessel
  int cells = 0;                     ///< cells at or above the threshold
};

/// What became of a px of the truth picture, for a figure.
enum class MapVerdict : std::uint8_t { unseen = 0, seen = 1, found = 2, wrong = 3, missed = 4 };

/// Judges maps against the sequence's vessels, frames in rising order. Places count that were in view in 9 frames;
/// the calibre is the label's. Costs a distance transform and a warped view per 3 frames: for reports, not for the
/// loop.
class MapScorer {
 public:
  static constexpr double kTolerance_px = 4.0;  ///< between a cell and a vessel, full-resolution px
  static constexpr int kSeenFrames = 9;

  /// @throws std::invalid_argument when the truth has no vessel picture
  explicit MapScorer(const Truth& truth);

  /// Scores the map as it stood after `frame`; frames must not fall from call to call.
  /// @throws std::invalid_argument for a frame that the truth does not have, or one before the last
  MapScore score(int frame, const retina::VesselMap& map);

  /// The verdict on each px of the truth picture (a `MapVerdict` each) of the last score.
  const cv::Mat_<std::uint8_t>& verdicts() const { return verdicts_; }

 private:
  void lookUntil(int frame);
  void judge(const cv::Mat_<std::uint8_t>& drawn, const cv::Mat_<float>& to_map);

  const Truth truth_;
  cv::Mat_<std::uint8_t> skeleton_, view_, verdicts_;
  cv::Mat_<float> to_vessel_;      // distance to the nearest vessel, px
  cv::Mat_<std::uint16_t> views_;  // in how many of every third frame a px was in view
  int next_frame_ = 0;
};

}  // namespace eyeslam::files
