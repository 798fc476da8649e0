// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

#include "eyeslam/simulation/condition.h"
#include "eyeslam/simulation/fundus.h"
#include "eyeslam/simulation/microscope.h"

namespace eyeslam::simulation {

struct SequenceOptions {
  cv::Size size{800, 608};
  int frames = 300;
  double fps = 30.0;
  std::uint64_t seed = 1;
};

/// The um per map px that a condition has for a seed and a width of the view.
/// A small view shows the same piece of retina as a large one, coarser; one above 800 px shows both more and finer.
double umPerPixel(const TissueOptions& tissue, const SequenceOptions& options);

/// A video of a fundus with exact truth, frame by frame.
///
///   SequenceRenderer renderer(fundus, condition("human"), {{800, 608}, 300, 30.0, 7});
///   while (const auto frame = renderer.next()) use(frame->image, frame->map_T_frame);
class SequenceRenderer {
 public:
  struct Rim {
    double x, y, radius;  ///< px
  };

  /// @throws std::invalid_argument when the fundus is too small for the motion
  SequenceRenderer(const Fundus& fundus, const Condition& condition, const SequenceOptions& options);

  /// The next frame, or none after the last. The image is the caller's.
  std::optional<RenderedFrame> next();

  /// Calibre of the vessels over all that comes into view, px; map coordinates of its pixel (0, 0): `vesselsOrigin()`.
  const cv::Mat_<float>& vessels() const { return vessels_; }
  cv::Point2d vesselsOrigin() const { return map_origin_; }
  double umPerPx() const { return um_per_px_; }
  /// Map px per px of the fundus.
  double zoom() const { return zoom_; }
  std::optional<Rim> rim() const;
  const EyeMotion& motion() const { return motion_; }

 private:
  struct Scene;
  SequenceRenderer(Scene scene, const Condition& condition, const SequenceOptions& options);

  SequenceOptions options_;
  double um_per_px_;
  double zoom_;
  EyeMotion motion_;
  cv::Mat_<float> vessels_;
  cv::Point2d map_origin_;
  Microscope microscope_;
  int frame_ = 0;
};

}  // namespace eyeslam::simulation
