// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

namespace eyeslam::simulation {

/// A retina as a picture: what a microscope looks at. All pictures have one size; a pixel is `um_per_px` wide.
struct Fundus {
  cv::Mat_<cv::Vec3f> bgr;       ///< colour under even white light, 0 to 1
  cv::Mat_<float> calibre_px;    ///< local vessel calibre, 0 = no vessel
  cv::Mat_<std::uint8_t> known;  ///< 255 where the picture shows retina; elsewhere its colour is made up
  double um_per_px = 0.0;
};

/// The same retina at `zoom` times as many pixels a mm; calibres follow.
Fundus resampled(const Fundus& fundus, double zoom);

/// Vessels on a background without any texture: the small structures that the truth does not name are gone as well.
Fundus withoutTexture(const Fundus& fundus);

/// Contrast against the local mean (over some 0.4 mm) times `factor`: ex vivo tissue is pale.
Fundus withContrast(const Fundus& fundus, double factor);

/// Fills what is not known from its surroundings, coarse to fine; known pixels keep their values.
/// @param known  255 where `picture` counts
cv::Mat_<cv::Vec3f> filledIn(const cv::Mat_<cv::Vec3f>& picture, const cv::Mat_<std::uint8_t>& known);

}  // namespace eyeslam::simulation
