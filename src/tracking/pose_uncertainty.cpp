// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/pose_uncertainty.h"

namespace eyeslam::tracking {

Eigen::Matrix3d honestCovariance(const Eigen::Matrix3d& refined, double ncc, const retina::Pose2& map_T_frame,
                                 const cv::Size& frame, const PoseUncertaintyOptions& options)
{
  const double distance = map_T_frame.translation().norm() / frame.width;
  const double noise = 1.0 - ncc * ncc;
  const double growth =
      (1.0 + options.distance_growth * distance * distance) * (1.0 + options.noise_growth * noise * noise);
  return options.mosaic_share * growth * refined;
}

}  // namespace eyeslam::tracking
