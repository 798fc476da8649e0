// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/full_pixels.h"

namespace eyeslam::tracking {

retina::Pose2 inFullPixels(const retina::Pose2& map_T_frame, const Frame& frame)
{
  const Eigen::Vector2d image_centre((frame.fullSize().width - 1) / 2.0, (frame.fullSize().height - 1) / 2.0);
  const Eigen::Vector2d offset = frame.centreInImage() - image_centre;
  const Eigen::Vector2d shift =
      frame.pixelSize().cwiseProduct(map_T_frame.translation()) + offset - map_T_frame.linear() * offset;
  return {shift.x(), shift.y(), map_T_frame.theta, map_T_frame.scale};
}

}  // namespace eyeslam::tracking
