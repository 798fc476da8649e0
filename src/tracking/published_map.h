// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/retina/vessel_map.h"
#include "eyeslam/tracking/map_vessel_detector.h"
#include "eyeslam/tracking/mosaic.h"
#include "eyeslam/tracking/occlusion_mask.h"

namespace eyeslam::tracking {

struct PublishedMapOptions {
  double threshold_log_odds = -0.7;
  int least_length = 12;
  int slice_work = 150;
  double renewal_samples = 0.5;
  double renewal_area = 0.08;
  int renewal_rows = 4096;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("threshold_log_odds", self.threshold_log_odds, Range{-7.0, 7.0}, "",
                  "a cell is called a vessel from here on; source: docs/vessel_map.md (lower finds more, and more that "
                  "is false)");
    visitor.field("least_length", self.least_length, Range{0, 64}, "cells",
                  "pieces of less extent are not called vessels; source: docs/vessel_map.md");
    visitor.field("slice_work", self.slice_work, Range{1, 100000}, "million multiplications",
                  "spent in a slice; a block of 128 x 128 cells takes 143 and about 7 ms; source: docs/vessel_map.md");
    visitor.field("renewal_samples", self.renewal_samples, Range{0.01, 100.0}, "of the samples it had",
                  "a block is looked at again once its mosaic gained so many; source: docs/vessel_map.md");
    visitor.field(
        "renewal_area", self.renewal_area, Range{0.001, 1.0}, "of what it knew",
        "or once so much more of it came into view (a quarter block counts at least); source: docs/vessel_map.md");
    visitor.field("renewal_rows", self.renewal_rows, Range{64, 100000000}, "rows of 64 px",
                  "or once so many rows were blended, for the retina changes: burns; source: 4096 are about 8 s");
  }
};

/// The published map: the vessels of the mosaic, for guidance and burns (the pose does not need it). A slice of work
/// follows each frame, on the blocks that changed most. What a block shows depends on the mosaic alone, never on the
/// order of the slices. Cells are mosaic px: one frame px. Never throws; memory is taken when the map grows.
class PublishedMap {
 public:
  /// Cells a side at most; what lies farther off is not published (`isCutOff`), what lies within stays in work.
  static constexpr int kLargestSide = 8192;

  explicit PublishedMap(const PublishedMapOptions& options = {});

  /// Forgets everything. @param px_per_cell  full px per mosaic px
  void start(double px_per_cell);
  /// Counts the cells of the map that a frame shows. @param mosaic_T_frame  frame px
  void observe(const OcclusionMask& mask, const cv::Size& frame, const Eigen::Vector2d& mosaic_centre,
               const retina::Pose2& mosaic_T_frame);
  /// Works one slice.
  void slice(const Mosaic& mosaic);
  /// Works on every block whose mosaic changed since it was looked at (seconds, not a slice).
  void finish(const Mosaic& mosaic);
  /// Says where the mosaic lies in the map frame (Anchor). The map is moved so that its middle is right; the turn, some
  /// 0.01 deg, is not followed by the cells: 0.1 full px at 500 px from the middle.
  /// @param map_T_mosaic  frame px
  void moveTo(const retina::Pose2& map_T_mosaic, const Eigen::Vector2d& mosaic_centre);

  /// Full-resolution px of the map frame; `um_per_px` is left to the program.
  const retina::VesselMap& map() const { return map_; }
  /// Whether retina was seen that the map has no room for.
  bool isCutOff() const { return cut_off_; }

 private:
  struct BlockState {
    std::uint32_t rows = 0;         // blended into its tiles until it was looked at
    std::uint32_t region_rows = 0;  // and into all that it depends on
    std::uint32_t samples = 0;
    int known = 0;  // px
    bool looked_at = false;
  };

  void grow(const cv::Rect& cells);
  std::optional<cv::Point> mostUrgent(const Mosaic& mosaic);
  double urgency(const Mosaic& mosaic, const cv::Point& at) const;
  BlockState stateNow(const Mosaic& mosaic, const cv::Point& at) const;
  void begin(const Mosaic& mosaic, const cv::Point& at);
  void finishBlock();
  void publish(const cv::Rect& cells);
  void place();
  BlockState& state(const cv::Point& at);
  const BlockState& state(const cv::Point& at) const;

  PublishedMapOptions options_;
  MapVesselDetector detector_;
  cv::Rect cells_;  // of the map, mosaic px, whole blocks
  bool cut_off_ = false;
  std::vector<BlockState> states_;
  cv::Mat_<std::int8_t> log_odds_;
  cv::Mat_<std::uint8_t> calibre_;
  std::array<std::uint8_t, 256> probability_{};  // of log odds + 128
  cv::Mat_<std::uint8_t> claimed_;
  cv::Mat labels_, extents_, centroids_;
  retina::Pose2 map_T_mosaic_;
  Eigen::Vector2d mosaic_centre_ = Eigen::Vector2d::Zero();
  retina::VesselMap map_;
};

}  // namespace eyeslam::tracking
