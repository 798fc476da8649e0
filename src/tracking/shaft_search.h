// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/occlusion_mask.h"

namespace eyeslam::tracking {

/// A straight instrument, roughly.
struct Shaft {
  Eigen::Vector2d end;        ///< where it ends in the view
  Eigen::Vector2d direction;  ///< unit vector along the axis, from the border towards the end
  double length = 0.0;        ///< of its visible part
  double width = 0.0;
};

/// Finds the instrument among a frame's cells: an elongated grey region that comes in from the border of the lit field.
/// Blooms are grey too, but round and mostly inside; where one touches the shaft it is trimmed off the axis.
class ShaftSearch {
 public:
  enum Kind : std::uint8_t { kRetina, kOutside, kTool, kTaken };

  /// @param grey_share    a cell is grey from this blue on, of its red (retina 0.12-0.3, burn 0.5, steel 0.9-1)
  /// @param bright_share  in images without colour: bright from this level on, of the median
  ShaftSearch(double grey_share, double bright_share) : grey_share_(grey_share), bright_share_(bright_share) {}

  /// @return the longest one, in full px of the image; nothing when no region is long and thin enough
  std::optional<Shaft> find(const Frame& frame, const OcclusionMask& mask);

 private:
  struct Region {
    std::size_t first = 0;  // into members_
    std::size_t last = 0;
  };

  void classify(const Frame& frame, const OcclusionMask& mask);
  bool touchesOutside(int column, int row) const;
  Region collect(int column, int row);
  std::optional<Shaft> fit(Region region);

  double grey_share_;
  double bright_share_;
  double least_elongation_ = 1.0;
  cv::Mat_<std::uint8_t> kinds_;
  std::vector<cv::Point> members_;
};

}  // namespace eyeslam::tracking
