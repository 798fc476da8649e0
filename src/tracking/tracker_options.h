// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/retina/options.h"
#include "eyeslam/tracking/aiming_spot.h"
#include "eyeslam/tracking/anchor.h"
#include "eyeslam/tracking/cross_vessel_smoother.h"
#include "eyeslam/tracking/dense_search.h"
#include "eyeslam/tracking/frame.h"
#include "eyeslam/tracking/mosaic.h"
#include "eyeslam/tracking/occlusion_mask.h"
#include "eyeslam/tracking/occupancy_map.h"
#include "eyeslam/tracking/point_selector.h"
#include "eyeslam/tracking/pose_filter.h"
#include "eyeslam/tracking/pose_uncertainty.h"
#include "eyeslam/tracking/published_map.h"
#include "eyeslam/tracking/refiner.h"
#include "eyeslam/tracking/relocalizer.h"
#include "eyeslam/tracking/ridge_detector.h"
#include "eyeslam/tracking/scale_evidence.h"
#include "eyeslam/tracking/scan_matcher.h"
#include "eyeslam/tracking/smear_model.h"
#include "eyeslam/tracking/spurious_detection_filter.h"
#include "eyeslam/tracking/structure_check.h"
#include "eyeslam/tracking/tool_tip_tracker.h"
#include "eyeslam/tracking/vessel_tracer.h"

namespace eyeslam::tracking {

/// How a match is verified against the mosaic (tracker study, 2.8 and 2.10).
struct LocalizerOptions {
  double least_visible = 0.10;
  int least_red = 30;
  double least_ncc = 0.4;
  double ncc_share = 0.65;
  int wide_cells = 40;
  int wide_steps = 8;
  int wide_points = 250;
  int sharp_points = 100;
  int undecided_frames = 4;
  double rival_ncc = 0.7;
  double scale_sigma = 0.002;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("least_visible", self.least_visible, Range{0.0, 1.0}, "of the frame",
                  "with less retina in view the frame is a blackout; source: tracker study 2.3");
    visitor.field("least_red", self.least_red, Range{0, 255}, "grey levels",
                  "with a lower median red the frame is a blackout; source: tracker study 2.3");
    visitor.field("least_ncc", self.least_ncc, Range{0.0, 1.0}, "",
                  "correlation of frame and mosaic below which a pose is wrong; source: tracker study 2.10");
    visitor.field("ncc_share", self.ncc_share, Range{0.0, 1.0}, "of the running mean",
                  "a candidate below it is kept, but the search goes on; source: tracker study 2.10");
    visitor.field("wide_cells", self.wide_cells, Range{4, 500}, "cells",
                  "half window of the second search; source: tracker study 2.8");
    visitor.field("wide_steps", self.wide_steps, Range{1, 90}, "angular steps of one cell at the corner",
                  "half window of the second search; source: tracker study 2.8");
    visitor.field("wide_points", self.wide_points, Range{30, 5000}, "points",
                  "of the second search; source: tracker study 2.8");
    visitor.field(
        "sharp_points", self.sharp_points, Range{0, 5000}, "points",
        "with fewer the frame is smeared, and the dense search replaces that of the whole map; source: rendered "
        "saccades, smeared frames have up to 40 points, sharp ones 400 and more");
    visitor.field("undecided_frames", self.undecided_frames, Range{1, 1000}, "frames",
                  "lost so long, the mosaic decides between places whose vessels fit alike, or is searched without "
                  "them; source: our choice, the eye moves on and most ambiguities pass");
    visitor.field("rival_ncc", self.rival_ncc, Range{0.0, 1.0}, "of the best place's",
                  "a second place that correlates as well leaves it undecided; source: wrong places of the rendered "
                  "retinas reach 0.2, repeated patterns 1");
    visitor.field("scale_sigma", self.scale_sigma, Range{1e-5, 1.0}, "",
                  "how far the scale may differ from the predicted, once it is free; source: tracker study 2.12");
  }
};

/// Every option of the tracker, a group for each step.
struct TrackerOptions {
  std::string detector = "ridge";
  FrameOptions frame;
  OcclusionMaskOptions occlusion;
  RidgeDetectorOptions ridge;
  VesselTracerOptions tracer;
  CrossVesselSmootherOptions smoother;
  SpuriousDetectionFilterOptions spurious;
  StructureCheckOptions structure;
  PointSelectorOptions selector;
  ScanMatcherOptions matcher;
  RelocalizerOptions relocalizer;
  LocalizerOptions localizer;
  DenseSearchOptions dense;
  RefinerOptions refiner;
  SmearModelOptions smear;
  PoseUncertaintyOptions uncertainty;
  PoseFilterOptions filter;
  OccupancyMapOptions occupancy;
  MosaicOptions mosaic;
  AnchorOptions anchor;
  ScaleEvidenceOptions scale;
  ToolTipOptions tool;
  AimingSpotOptions aiming_spot;
  PublishedMapOptions published;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    visitor.choice("detector", self.detector, {"ridge", "tracing"},
                   "what finds vessel points; source: docs/results.md, the better one per microsecond");
    visitor.group("frame", self.frame);
    visitor.group("occlusion", self.occlusion);
    visitor.group("ridge", self.ridge);
    visitor.group("tracer", self.tracer);
    visitor.group("smoother", self.smoother);
    visitor.group("spurious", self.spurious);
    visitor.group("structure", self.structure);
    visitor.group("selector", self.selector);
    visitor.group("matcher", self.matcher);
    visitor.group("relocalizer", self.relocalizer);
    visitor.group("localizer", self.localizer);
    visitor.group("dense", self.dense);
    visitor.group("refiner", self.refiner);
    visitor.group("smear", self.smear);
    visitor.group("uncertainty", self.uncertainty);
    visitor.group("filter", self.filter);
    visitor.group("occupancy", self.occupancy);
    visitor.group("mosaic", self.mosaic);
    visitor.group("anchor", self.anchor);
    visitor.group("scale", self.scale);
    visitor.group("tool", self.tool);
    visitor.group("aiming_spot", self.aiming_spot);
    visitor.group("published", self.published);
  }
};

}  // namespace eyeslam::tracking
