// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/masked_contrast.h"
#include "eyeslam/tracking/occlusion_mask.h"
#include "eyeslam/tracking/track_result.h"
#include "eyeslam/tracking/tracker_options.h"

namespace eyeslam::tracking {

/// How every method begins: an image made ready, what hides the retina in it, and whether enough is left to see.
///
///   if (const Reason why = picture.assign(image); why != Reason::none) return refuse(why);
///   detector.detect(picture.frame(), picture.mask(), points);
class MaskedFrame {
 public:
  /// Uses the groups `frame`, `occlusion` and, for what counts as dark, `localizer`.
  explicit MaskedFrame(const TrackerOptions& options);

  /// Takes an image (Frame::assign), masks it and frees it of its background; keeps no reference.
  /// @return none, wrong_size, or blackout: then there is a mask but no contrast
  retina::Reason assign(const cv::Mat& image);

  const Frame& frame() const { return frame_; }
  const OcclusionMask& mask() const { return mask_; }
  /// Valid until the next call of `assign`.
  MaskedContrast contrast() const { return {frame_, mask_}; }
  /// Frame px.
  cv::Size size() const { return {frame_.width(), frame_.height()}; }

 private:
  bool isDark() const;

  double least_visible_;
  int least_red_;
  Frame frame_;
  OcclusionMask mask_;
};

/// Marks a frame as not tracked; the pose stays the last good one.
const TrackResult& refuseFrame(TrackResult& result, retina::Reason why, int points = 0);

}  // namespace eyeslam::tracking
