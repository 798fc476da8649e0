// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/retina/options.h"

namespace eyeslam::tracking {

struct TracingKernelOptions {
  int length_px = 7;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("length_px", self.length_px, Range{3, 7}, "frame px",
                  "length of an edge template along the vessel; source: Can 1999 by facts A2.3 (7 to 9 px proposed)");
  }
};

/// Both edges of a vessel across one place, as the directed templates see them.
struct VesselEdges {
  int left = 0;          ///< average contrast over the left edge, in 1 / Frame::kContrastUnit; positive: darker inside
  int right = 0;         ///< the same over the right edge
  int left_offset = 0;   ///< distance of the left edge, steps against the normal axis
  int right_offset = 0;  ///< distance of the right edge, steps along the normal axis
  int sum() const { return left + right; }
};

/// Directed edge templates in 16 directions, 22.5 degrees apart (Can 1999, facts A2.3.3).
///
/// The cross-section is the low-pass derivative (-1 -2 0 2 1), repeated along the direction. Directions s and s + 8
/// share an axis, so eight orientations are evaluated. The cross-section runs along the picture's axis that is nearer
/// to the normal (the template is sheared, not turned): a template is then a sum of shifted rows, of the picture or of
/// its transpose, and all offsets of both edges come from one profile.
class TracingKernels {
 public:
  static constexpr int kDirections = 16;
  static constexpr int kOrientations = 8;
  /// Farthest edge from the middle, steps along the normal axis.
  static constexpr int kFarthestEdge = 8;

  explicit TracingKernels(const TracingKernelOptions& options = {});

  /// Takes the plane to look at (`Frame::contrast()`, vessels negative), padded by its border; keeps no reference.
  /// Allocates with the first plane only.
  void assign(const cv::Mat_<std::int16_t>& plane);

  /// The best edges on both sides of (x, y), a pixel of the plane, each `nearest` to `farthest` steps away.
  /// @param orientation  [0, 8): of the vessel, in steps of 22.5 deg from x towards y
  /// @param nearest, farthest  1 <= nearest <= farthest <= kFarthestEdge
  VesselEdges evaluate(int x, int y, int orientation, int nearest, int farthest) const;

  /// Unit vector of a direction [0, 16), image axes.
  const Eigen::Vector2f& direction(int index) const { return directions_[static_cast<std::size_t>(index)]; }
  /// The axis along which offsets of an orientation are counted: (1, 0) or (0, 1).
  static Eigen::Vector2f normalAxis(int orientation);
  /// Width across the vessel per step of offset.
  float widthPerStep(int orientation) const;

 private:
  struct Template {
    bool transposed = false;
    int rows = 0;
    std::array<int, 7> shift{};  // of each row, px
    int weight = 0;              // of the derivative, so that a step edge reads as its height
  };

  std::array<Eigen::Vector2f, kDirections> directions_;
  std::array<Template, kOrientations> templates_;
  cv::Mat_<std::int16_t> upright_, transposed_;
};

}  // namespace eyeslam::tracking
