// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "eyeslam/files/map_files.h"
#include "eyeslam/files/vector_picture.h"
#include "eyeslam/fixtures/burn_plan.h"
#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::files {

/// A picture to draw a plan over, and where it lies.
struct PlanBackground {
  cv::Mat picture;  ///< 8 bit, BGR
  PictureGeometry geometry;
};

/// What of a plan is drawn beside its burns.
struct PlanDrawingOptions {
  bool travel = false;  ///< the way from burn to burn
};

/// The seen part of a map in muted colours, between the white and the black of burns: vessels dark red, retina seen too
/// seldom grey.
PlanBackground mapBackground(const retina::VesselMap& map, int vessel_probability, int seen_frames);

/// The plan as in Fig. 8 of the EyeSLAM paper: burns in their true size, white where they are allowed and black where
/// they are refused, over the retina; keep-out zones, tiles where there are several, scale bar and legend. A burn of
/// less than 3 px in the figure is drawn with 3.
VectorPicture drawPlan(const fixtures::BurnPlan& plan, const PlanBackground& background,
                       const PlanDrawingOptions& options);

}  // namespace eyeslam::files
