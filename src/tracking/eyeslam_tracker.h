// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <visp3/core/vpColor.h>
#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>
#include <visp3/core/vpTracker.h>

#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/vessel_map.h"
#include "eyeslam/tracking/track_result.h"
#include "eyeslam/tracking/tracker_options.h"

namespace eyeslam::tracking {

/// Maps the vessels of the retina and says in every frame where the view is (EyeSLAM).
///
///   EyeSlamTracker tracker;
///   tracker.initTracking(I);          // the map's frame is the first good frame
///   while (grab(I)) {
///     const TrackResult& result = tracker.track(I);
///     if (result.tracked) use(result.map_T_frame);
///     tracker.updateMap();            // a slice of the published map; may be left out
///   }
///
/// One thread, repeatable to the byte for the same input, options and seed; no exception and no allocation in steady
/// state. `vpTracker::p` holds (x, y, theta, scale) of the last result.
class EyeSlamTracker : public vpTracker {
 public:
  explicit EyeSlamTracker(const TrackerOptions& options = {});
  ~EyeSlamTracker() override;

  /// Forgets everything and starts with I as frame 0.
  const TrackResult& initTracking(const vpImage<vpRGBa>& I);
  const TrackResult& initTracking(const vpImage<unsigned char>& I);
  const TrackResult& initTracking(const cv::Mat& image);

  /// Localizes one frame and updates the map. A first call without `initTracking` is frame 0.
  /// @return the result, valid until the next call; a frame that cannot be used is `tracked == false` with its reason
  const TrackResult& track(const vpImage<vpRGBa>& I);
  const TrackResult& track(const vpImage<unsigned char>& I);
  /// 8 or 16 bit, one (grey) or three (BGR) channels.
  const TrackResult& track(const cv::Mat& image);

  /// Works one slice on the published vessel map; call it after `track`, or not at all.
  void updateMap();
  /// Finishes the published map over everything seen so far (takes seconds, not a slice).
  void finishMap();

  const TrackResult& getResult() const;
  const retina::Pose2& getPose() const { return getResult().map_T_frame; }
  const ToolTip& getToolTip() const;
  const AimingSpot& getAimingSpot() const;
  /// The vessel points found in the last frame, full px of the image.
  std::vector<cv::Point2f> getPoints() const;
  /// The published vessel map; full-resolution px, cells of `px_per_cell`.
  const retina::VesselMap& getVesselMap() const;
  /// Whether more retina was seen than the published map may hold (PublishedMap::kLargestSide).
  bool isMapCutOff() const;
  /// The retina seen so far in BGR, 8 bit, one pixel a processed pixel; black where never seen.
  /// @param origin        set to the map coordinates (full px) of the centre of the picture's pixel (0, 0)
  /// @param px_per_pixel  set to the full px a picture's pixel
  cv::Mat getMosaic(cv::Point2d& origin, double& px_per_pixel) const;

  /// Draws map points and instrument into the window that shows I (ViSP's habit).
  void display(const vpImage<vpRGBa>& I, const vpColor& color = vpColor::cyan, unsigned int thickness = 1) const;
  void display(const vpImage<unsigned char>& I, const vpColor& color = vpColor::cyan, unsigned int thickness = 1) const;

 private:
  class Steps;
  std::unique_ptr<Steps> steps_;  // so that users compile against ViSP and OpenCV's core alone
};

}  // namespace eyeslam::tracking
