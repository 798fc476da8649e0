// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/tracking/mosaic.h"
#include "eyeslam/tracking/vessel_net.h"

namespace eyeslam::tracking {

/// Finds the vessels in one block of the mosaic: every pixel's log odds and the width of the vessel there. A block is
/// worked in steps of a few milliseconds at most, on the mosaic as it was when the block began.
class MapVesselDetector {
 public:
  static constexpr int kBlock = 128;                                ///< mosaic px
  static constexpr int kApron = (VesselNet::kRegion - kBlock) / 2;  ///< mosaic px looked at around a block
  /// `logOdds` is stored in steps of 1 / kLogOddsUnit; kNeverSeen where the mosaic knows nothing.
  static constexpr int kLogOddsUnit = 16;
  static constexpr std::int8_t kNeverSeen = -128;

  /// The pixels of a block, and those that it depends on; mosaic px.
  static cv::Rect block(const cv::Point& at) { return {at.x * kBlock, at.y * kBlock, kBlock, kBlock}; }
  static cv::Rect region(const cv::Point& at)
  {
    return {at.x * kBlock - kApron, at.y * kBlock - kApron, VesselNet::kRegion, VesselNet::kRegion};
  }

  MapVesselDetector();

  void begin(const Mosaic& mosaic, const cv::Point& at);
  /// @return multiplications spent; 0 when the block is done
  std::size_t step() { return net_.step(); }
  bool isBusy() const { return busy_; }
  bool isDone() const { return busy_ && net_.done(); }
  const cv::Point& at() const { return at_; }
  /// Hands out a finished block: log odds in steps, vessel width in mosaic px times `px_per_cell`, both kBlock x
  /// kBlock.
  void finish(double px_per_cell, cv::Mat_<std::int8_t> log_odds, cv::Mat_<std::uint8_t> calibre);

 private:
  VesselNet net_;
  cv::Point at_;
  bool busy_ = false;
  cv::Mat_<std::int16_t> contrast_;
  cv::Mat_<std::uint8_t> count_;
};

}  // namespace eyeslam::tracking
