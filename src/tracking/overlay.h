// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/vessel_map.h"
#include "eyeslam/tracking/track_result.h"

namespace eyeslam::tracking {

struct OverlayOptions {
  int panel_width = 640;
  int trail_frames = 600;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("panel_width", self.panel_width, Range{160, 1920}, "px",
                  "widest panel; frames are shrunk to it, in half at least; source: our choice");
    visitor.field("trail_frames", self.trail_frames, Range{1, 1e6}, "frames",
                  "how much of the trajectory is drawn; source: our choice, 20 s at 30 Hz");
  }
};

/// What one picture of the overlay shows; nothing is kept but the trajectory.
struct OverlayScene {
  const cv::Mat& frame;                    ///< the image as it came: 8 or 16 bit, grey or BGR, always of one size
  const std::vector<cv::Point2f>& points;  ///< detected vessel points, full px of the image
  const retina::VesselMap& map;            ///< may be empty
  const cv::Mat& mosaic;                   ///< BGR, 8 bit; may be empty
  cv::Point2d mosaic_origin;               ///< map coordinates (full px) of the mosaic's pixel (0, 0)
  double mosaic_px_per_pixel = 1.0;        ///< full px a mosaic pixel
  const TrackResult& result;
  const ToolTip& tip;
  double time_s = 0.0;
  AimingSpot spot = {};
};

/// The four panels of the paper's Fig. 1: the frame with its vessel points; the map with the outline of the view; the
/// frame with the map's vessels brought back into it, and the instrument; the mosaic with the path of the view's
/// centre. A line below says frame, time, pose, and why a frame was refused. About 5 ms a picture.
class Overlay {
 public:
  explicit Overlay(const OverlayOptions& options = {});

  /// @return BGR, 8 bit, of even width and height (as video encoders want), the same size for all frames; valid until
  ///         the next call
  const cv::Mat& draw(const OverlayScene& scene);

 private:
  void layOut(cv::Size frame);
  void follow(const OverlayScene& scene);
  cv::Matx23d panelFromMap() const;
  void drawDetections(const OverlayScene& scene, cv::Mat panel) const;
  void drawMap(const OverlayScene& scene, cv::Mat panel);
  void drawReprojection(const OverlayScene& scene, cv::Mat panel);
  void drawMosaic(const OverlayScene& scene, cv::Mat panel);
  void drawInstrument(const ToolTip& tip, cv::Mat& panel) const;
  void drawSpot(const AimingSpot& spot, cv::Mat& panel) const;
  void drawOutline(const OverlayScene& scene, cv::Mat& panel) const;
  void writeStatus(const OverlayScene& scene, cv::Mat line) const;

  OverlayOptions options_;
  cv::Size frame_, panel_;
  double panel_per_px_ = 1.0;
  cv::Mat small_, canvas_;  // the frame at the panel's size; all panels
  cv::Mat grid_, warped_, colours_, palette_, unseen_;
  cv::Rect2d seen_;  // of the map, full px: all views so far
  std::vector<cv::Point2d> trail_;
};

}  // namespace eyeslam::tracking
