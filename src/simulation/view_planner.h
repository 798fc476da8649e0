// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "eyeslam/simulation/fundus.h"
#include "eyeslam/simulation/view_motion.h"

namespace eyeslam::simulation {

/// Where on a fundus a video begins, and what of the fundus it will show.
struct ViewPlan {
  cv::Point start;           ///< fundus px under the image centre of frame 0
  cv::Rect area;             ///< all that comes into view with a margin, within the fundus
  double known_share = 0.0;  ///< of the sampled view points that lie on known retina, [0, 1]
};

struct ViewPlanRequest {
  cv::Size view;
  double fps = 30.0;
  int frames = 1;
  double field_radius = 0.0;  ///< px of the frame; farther points are behind the rim; 0 = no rim
  std::uint64_t seed = 1;
  std::optional<cv::Point> start;  ///< fundus px, where somebody has chosen the place
};

/// Tries seeded places and takes one from which the whole motion stays on known retina and begins among vessels.
/// @throws std::invalid_argument when the fundus is smaller than the view, or no place keeps 90 % of it on known retina
ViewPlan planView(const Fundus& fundus, const ViewMotion& motion, const ViewPlanRequest& request);

}  // namespace eyeslam::simulation
