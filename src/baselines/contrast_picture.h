// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/occlusion_mask.h"

namespace eyeslam::baselines {

/// A normalised frame as OpenCV's methods want it: 8 bit, 128 = as bright as the background, 20 % less = 100 levels
/// less; and 255 where the retina shows.
void makeContrastPicture(const tracking::Frame& frame, const tracking::OcclusionMask& mask, cv::Mat& picture,
                         cv::Mat& visible);

}  // namespace eyeslam::baselines
