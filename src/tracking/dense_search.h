// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/tracking/masked_contrast.h"
#include "eyeslam/tracking/mosaic.h"

namespace eyeslam::tracking {

struct DenseSearchOptions {
  int reach_cells = 16;
  double least_ncc = 0.15;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("reach_cells", self.reach_cells, Range{1, 64}, "cells of 8 px",
                  "shifts searched each way; source: tracker study 2.11b (128 px)");
    visitor.field("least_ncc", self.least_ncc, Range{0.0, 1.0}, "",
                  "a weaker place is none; source: a grey saccade has 0.22, and the mosaic confirms");
  }
};

/// Finds a frame that is too smeared for vessel points: coarse correlation of its contrast with the mosaic, over shifts
/// at the predicted angle (tracker study, 2.11b).
class DenseSearch {
 public:
  explicit DenseSearch(const DenseSearchOptions& options = {});

  /// @param around  where to search; its angle and scale are kept
  /// @return  the shifted pose (within about 2 px), or nothing when no place correlates
  std::optional<retina::Pose2> find(const Mosaic& mosaic, const MaskedContrast& frame, const retina::Pose2& around);

 private:
  static constexpr int kCell = 8;  // px
  void shrinkFrame(const MaskedContrast& frame, const retina::Pose2& around);
  void shrinkMosaic(const Mosaic& mosaic, const retina::Pose2& around);
  float correlate(int dx, int dy) const;

  DenseSearchOptions options_;
  // Cell means and weights (1 = known), the frame turned into the map's axes, the mosaic wider by the reach.
  cv::Mat_<float> frame_mean_, frame_known_, mosaic_mean_, mosaic_known_;
  cv::Mat_<std::int16_t> mean_;
  cv::Mat_<std::uint8_t> count_;
};

}  // namespace eyeslam::tracking
