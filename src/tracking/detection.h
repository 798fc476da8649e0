// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "eyeslam/tracking/tracker_options.h"
#include "eyeslam/tracking/vessel_detector.h"

namespace eyeslam::tracking {

/// The detector that the options name: dense ridges, or exploratory tracing followed by smoothing across the vessel.
/// Both cull what the paper's colour, bloom, rim and instrument tests explain.
std::unique_ptr<VesselDetector> makeDetector(const TrackerOptions& options);

}  // namespace eyeslam::tracking
