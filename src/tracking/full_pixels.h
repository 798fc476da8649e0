// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/frame.h"

namespace eyeslam::tracking {

/// A pose in frame px about the frame's centre, as the pose in full px about the image's centre. The two centres differ
/// where an odd row or column was dropped.
retina::Pose2 inFullPixels(const retina::Pose2& map_T_frame, const Frame& frame);

}  // namespace eyeslam::tracking
