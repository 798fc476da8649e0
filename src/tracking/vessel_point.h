// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace eyeslam::tracking {

// Three kinds of pixel, everywhere in this library:
//   full px       pixels of the picture as it came; only EyeSlamTracker's interface and the files speak them
//   frame px      pixels of the processed (by default halved) picture; (0, 0) is the centre of the top-left pixel
//   centred px    frame px relative to the image centre ((w - 1) / 2, (h - 1) / 2), or map px relative to the centre of
//                 frame 0: `map_T_frame * d` takes centred frame px to centred map px

/// A point on a vessel in one frame: one element of the paper's observation Z_t.
struct VesselPoint {
  float x = 0.0F;          ///< frame px
  float y = 0.0F;          ///< frame px
  float strength = 0.0F;   ///< contrast of the vessel against its surroundings, as a fraction of the background
  float direction = 0.0F;  ///< of the vessel, rad in image axes, modulo pi
  float calibre = 0.0F;    ///< width of the vessel, frame px; 0 = not measured
};

using VesselPoints = std::vector<VesselPoint>;

/// Points for matching and mapping, centred px.
using ScanPoints = std::vector<Eigen::Vector2f>;

}  // namespace eyeslam::tracking
