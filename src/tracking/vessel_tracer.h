// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/tracing_kernels.h"
#include "eyeslam/tracking/vessel_detector.h"

namespace eyeslam::tracking {

struct VesselTracerOptions {
  TracingKernelOptions kernels;
  int grid_pitch_px = 12;
  double seed_depth = 2.7;
  double seed_strength = 5.5;
  double edge_strength = 3.6;
  double lowest_strength = 0.02;
  double weaker_edge = 0.25;
  double fading = 0.5;
  int farthest_edge_px = 8;
  double step_px = 2.5;
  int turn = 2;
  int weak_steps = 2;
  int shortest_trace = 8;
  int most_points = 4000;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.group("kernels", self.kernels);
    visitor.field("grid_pitch_px", self.grid_pitch_px, Range{4, 64}, "frame px",
                  "distance of the lines on which seeds are sought; source: facts A2.3 (12 to 16 proposed)");
    visitor.field("seed_depth", self.seed_depth, Range{0.0, 100.0}, "noise sigmas",
                  "how far under the median level a seed lies; source: eyeslam-bench detect");
    visitor.field("seed_strength", self.seed_strength, Range{0.0, 100.0}, "noise sigmas",
                  "least sum of both edge responses where a trace begins; source: eyeslam-bench detect");
    visitor.field("edge_strength", self.edge_strength, Range{0.0, 100.0}, "noise sigmas",
                  "least sum of both edge responses where a trace goes on; source: eyeslam-bench detect");
    visitor.field("lowest_strength", self.lowest_strength, Range{0.0, 1.0}, "fraction of the background",
                  "least sum of both edge responses however calm the picture; source: tracker study 2.5 (0.03)");
    visitor.field("weaker_edge", self.weaker_edge, Range{0.0, 1.0}, "of the stronger edge",
                  "a vessel has two edges, a shaft or a bloom one; source: eyeslam-bench detect");
    visitor.field("fading", self.fading, Range{0.0, 1.0}, "of the last steps' mean",
                  "a step with weaker edges is weak: traces end where vessels do; source: ends of drawn vessels");
    visitor.field("farthest_edge_px", self.farthest_edge_px, Range{2, TracingKernels::kFarthestEdge}, "frame px",
                  "half of the widest vessel, along an axis; source: facts A2.3 (7 px, at 45 deg 8 are 6)");
    visitor.field("step_px", self.step_px, Range{1.0, 5.0}, "frame px",
                  "between two points of a trace; source: facts A2.3 (2 to 3 px)");
    visitor.field("turn", self.turn, Range{1, 3}, "steps of 22.5 deg",
                  "tested to either side at each step; source: paper, wider than Can's 1 (facts A2.3.6)");
    visitor.field("weak_steps", self.weak_steps, Range{0, 10}, "steps",
                  "below the threshold that a trace survives; source: facts A2.3 (2 to 3)");
    visitor.field("shortest_trace", self.shortest_trace, Range{1, 100}, "points",
                  "shorter traces are noise; source: eyeslam-bench detect");
    visitor.field("most_points", self.most_points, Range{100, 60000}, "points",
                  "tracing stops there (counted work, not time: repeatable); source: five times what a view has");
  }
};

/// Exploratory vessel tracing after Can et al. 1999 with the paper's wider turning (facts A2.3): levels from a sparse
/// grid, seeds on its lines, then each vessel is followed from its seed both ways, a few templates a step, until it
/// ends. Only pixels at vessels are ever looked at. Points come in the order of the traces; positions are good to half
/// a pixel (CrossVesselSmoother makes them finer). Repeatable; no allocation after the first frame of a size.
class VesselTracer : public VesselDetector {
 public:
  explicit VesselTracer(const VesselTracerOptions& options = {});

  void detect(const Frame& frame, const OcclusionMask& mask, VesselPoints& points) override;

 private:
  struct Seed {
    int depth = 0;  // under the median level
    int x = 0;
    int y = 0;
  };
  struct Levels {  // of the plane, 1 / Frame::kContrastUnit
    int median = 0;
    int seed = 0;   // seeds are darker
    int start = 0;  // least sum of both edges where a trace begins
    int go_on = 0;  // and where it goes on
  };
  struct Place {  // where a trace stands
    float x = 0.0F;
    float y = 0.0F;
    int direction = 0;  // [0, 16)
    VesselEdges edges;
  };

  void estimateLevels(const cv::Mat_<std::int16_t>& plane, const OcclusionMask& mask);
  Levels estimateLevels(const cv::Mat_<std::int16_t>& plane, const OcclusionMask& mask, const cv::Rect& tile);
  const Levels& levelsAt(int x, int y) const;
  void consider(const std::int16_t* at, std::ptrdiff_t step, int x, int y, const OcclusionMask& mask);
  void findSeeds(const cv::Mat_<std::int16_t>& plane, const OcclusionMask& mask);
  void keepStrongest();
  static bool isStronger(const Seed& a, const Seed& b);
  bool validate(const Seed& seed, const OcclusionMask& mask, Place& place) const;
  void trace(const Place& seed, const OcclusionMask& mask, VesselPoints& points);
  void follow(Place place, const OcclusionMask& mask, VesselPoints& points);
  Place bestPlace(const Place& from, int x, int y) const;
  void centre(Place& place) const;
  bool isStrong(const Place& place, int least) const;
  bool isFree(const Place& place, const OcclusionMask& mask) const;
  void claim(const Place& place);
  float calibre(const Place& place) const;
  VesselPoint pointAt(const Place& place) const;
  bool isFull(const VesselPoints& points) const;

  VesselTracerOptions options_;
  TracingKernels kernels_;
  std::vector<Levels> levels_;  // of each tile of the view, row by row
  int tile_columns_ = 0;
  std::vector<int> levels_seen_, differences_;  // histograms of a tile
  std::vector<Seed> seeds_;
  cv::Mat_<std::uint16_t> labels_;  // number of the step that claimed the pixel, from 1; 0 = free
  int claims_ = 0;                  // steps so far
  int trace_start_ = 0;             // claims before this trace, and before this branch of it
  int branch_start_ = 0;
};

}  // namespace eyeslam::tracking
