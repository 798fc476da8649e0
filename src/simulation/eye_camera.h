// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

#include "eyeslam/simulation/condition.h"
#include "eyeslam/simulation/eye_camera_options.h"
#include "eyeslam/simulation/frame_shutter.h"
#include "eyeslam/simulation/fundus.h"
#include "eyeslam/simulation/microscope.h"

namespace eyeslam::simulation {

/// The microscope's camera over the 1 kHz world: renders what a `FrameDue` recorded.
///
///   EyeCamera camera(options, fundus, seed);            // some 0.1 s: prepares the retina
///   if (const auto due = hardware.frameDue()) use(camera.render(*due).image);   // this thread or another
///
/// Frames may be left out; burns stay. The same frames give the same pictures, to the byte.
class EyeCamera {
 public:
  /// @throws std::invalid_argument for an unknown condition, or a fundus that is too small for the view and the reach
  EyeCamera(const EyeCameraOptions& options, const Fundus& fundus, std::uint64_t seed);

  /// In the order of frames. The image is the caller's. The truth beside it is in px of the map whose frame 0 shows the
  /// retina where it was at the start, the picture not yet wandered.
  RenderedFrame render(const FrameDue& due);

  cv::Size size() const { return size_; }
  double umPerPx() const { return um_per_px_; }
  /// Calibre of the vessels over all that may come into view, px; map coordinates of its pixel (0, 0): `vesselsOrigin`.
  const cv::Mat_<float>& vessels() const { return vessels_; }
  cv::Point2d vesselsOrigin() const { return map_origin_; }
  /// The same part of the retina under even white light: 8 bit, BGR.
  const cv::Mat& retina() const { return retina_; }

 private:
  struct Scene;
  EyeCamera(const EyeCameraOptions& options, const Condition& condition, const Scene& scene, std::uint64_t seed);

  cv::Size size_;
  double um_per_px_;
  cv::Mat_<float> vessels_;
  cv::Point2d map_origin_;
  cv::Mat retina_;
  Microscope microscope_;
  std::size_t burnt_ = 0;
  RenderedFrame last_;
};

/// Those that such a camera shows with this seed.
SpecularBlooms specularBlooms(const EyeCameraOptions& options, std::uint64_t seed);

}  // namespace eyeslam::simulation
