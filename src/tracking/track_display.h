// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <visp3/core/vpColor.h>
#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "eyeslam/retina/vessel_map.h"
#include "eyeslam/tracking/track_result.h"

namespace eyeslam::tracking {

/// Draws the map's vessels and the instrument into the window that shows I (`EyeSlamTracker::display`); nothing when no
/// window does. Vessels only where the frame was tracked. `vpDisplay::flush(I)` is the caller's, as ViSP has it.
void displayTrack(const vpImage<vpRGBa>& I, const retina::VesselMap& map, const TrackResult& result, const ToolTip& tip,
                  const vpColor& color, unsigned int thickness);
void displayTrack(const vpImage<unsigned char>& I, const retina::VesselMap& map, const TrackResult& result,
                  const ToolTip& tip, const vpColor& color, unsigned int thickness);

}  // namespace eyeslam::tracking
