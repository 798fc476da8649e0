// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/masked_contrast.h"
#include "eyeslam/tracking/mosaic.h"

namespace eyeslam::tracking {

/// The pixels that a frame is aligned to: position, value and gradient of each, as arrays for vector units.
/// Clusters are groups of neighbours whose residuals may be alike (compression, texture that moved); they lie one
/// behind the other.
struct AlignmentTemplate {
  std::vector<float> x, y;                  ///< centred map px
  std::vector<float> value;                 ///< contrast units
  std::vector<float> gx, gy;                ///< contrast units per px
  std::vector<std::size_t> cluster_begins;  ///< index of each cluster's first pixel

  std::size_t size() const { return x.size(); }
  void clear();
  void reserve(std::size_t pixels);
  void push(float px, float py, float pixel_value, float pixel_gx, float pixel_gy);
  /// The end of cluster c.
  std::size_t clusterEnd(std::size_t c) const { return c + 1 < cluster_begins.size() ? cluster_begins[c + 1] : size(); }
};

/// Fills `pixels` with the mosaic's template pixels that a frame at this pose sees, unmasked and away from its border.
void collectTemplate(const Mosaic& mosaic, const MaskedContrast& frame, const retina::Pose2& map_T_frame,
                     AlignmentTemplate& pixels);

/// Fills `visible` with those of `pixels` that a frame at this pose sees, unmasked and away from its border.
void selectVisible(const AlignmentTemplate& pixels, const MaskedContrast& frame, const retina::Pose2& map_T_frame,
                   AlignmentTemplate& visible);

}  // namespace eyeslam::tracking
