// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
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

/// One way to follow the retina from frame to frame, behind one interface, so that programs run and benchmarks compare
/// them alike. All results speak full-resolution px (contracts, section 1).
class Method {
 public:
  virtual ~Method() = default;

  /// Localizes one frame: 8 or 16 bit, one (grey) or three (BGR) channels, all of one size and type. The first frame
  /// fixes the map's frame. The result is valid until the next call; a frame that cannot be used is `tracked == false`
  /// with its reason, never an exception.
  virtual const tracking::TrackResult& track(const cv::Mat& image) = 0;

  /// One slice of work on the published map, after `track`.
  virtual void updateMap() {}
  /// Finishes the published map over everything seen so far.
  virtual void finishMap() {}
  /// The published map; empty when the method keeps none.
  virtual const retina::VesselMap& vesselMap() const = 0;
  virtual Mosaic mosaic() const { return {}; }
  /// The tracker behind the method where it is EyeSLAM itself, else null: pictures show its inside.
  virtual const tracking::EyeSlamTracker* eyeSlam() const { return nullptr; }
};

/// Names for `--method`, the default first.
std::vector<std::string> methodNames();

/// The method of a name in `methodNames()`.
/// @param options  of EyeSLAM; other methods take from it what they share (the scale)
/// @param seed     of every random choice
/// @throws std::invalid_argument naming the methods there are
std::unique_ptr<Method> makeMethod(const std::string& name, const tracking::TrackerOptions& options,
                                   std::uint64_t seed);

}  // namespace eyeslam::baselines
