// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/occlusion_mask.h"
#include "eyeslam/tracking/vessel_point.h"

namespace eyeslam::tracking {

/// Finds vessel points in a frame: exploratory tracing (VesselTracer) or dense ridges (RidgeDetector).
class VesselDetector {
 public:
  virtual ~VesselDetector() = default;
  /// Fills `points` (cleared first; capacity is kept) from a normalised frame; none lies on a masked cell.
  virtual void detect(const Frame& frame, const OcclusionMask& mask, VesselPoints& points) = 0;
};

}  // namespace eyeslam::tracking
