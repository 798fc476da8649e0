// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "eyeslam/retina/vessel_map.h"
#include "eyeslam/tracking/track_result.h"
#include "eyeslam/tracking/tracker_options.h"

namespace eyeslam::tracking {
class EyeSlamTracker;
}

namespace eyeslam::baselines {

/// The retina seen so far as one picture: BGR, 8 bit, black where never seen.
struct Mosaic {
  cv::Mat picture;            ///< empty when the method keeps none
  cv::Point2d origin;         ///< where the centre of the picture's pixel (0, 0) lies in the map frame, full px
  double px_per_pixel = 1.0;  ///< full px per pixel of the picture
};

/// A way to say where the view is: this tracker's rivals, and the tracker itself, behind one interface.
///
///   auto method = makeMethod("paper", options);
///   while (grab(image)) use(method->track(image).map_T_frame);
///
/// The rivals may allocate and take their time; like the tracker they are repeatable for the same input and seed.
class Method {
 public:
  virtual ~Method() = default;

  /// Localizes one image, 8 or 16 bit, grey or BGR; the first usable one is frame 0 of the map.
  /// @return pose in full px; valid until the next call
  virtual const tracking::TrackResult& track(const cv::Mat& image) = 0;

  /// The slice of the published map that follows a frame; nothing where a method has no map.
  virtual void updateMap() {}
  /// Finishes the published map over everything seen so far; may take seconds.
  virtual void finishMap() {}
  /// The published vessel map so far, empty where a method has none; valid until the next call of this object.
  virtual const retina::VesselMap& vesselMap() = 0;
  virtual Mosaic mosaic() const { return {}; }
  /// The vessel points found in the last frame, full px of the image; none where a method has none.
  virtual std::vector<cv::Point2f> points() const { return {}; }
  /// The tracker itself where the method is EyeSLAM, else null: pictures show what is inside it.
  virtual const tracking::EyeSlamTracker* eyeSlam() const { return nullptr; }
};

/// All names that `makeMethod` knows, `eyeslam` first.
std::vector<std::string> methodNames();

/// The method of that name. Of `options`, rivals use the frame's scale, the masks and the seed.
/// @throws std::invalid_argument naming the known methods when there is none of that name
std::unique_ptr<Method> makeMethod(const std::string& name, const tracking::TrackerOptions& options);

}  // namespace eyeslam::baselines
