// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <ostream>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/simulation/procedural_fundus.h"
#include "eyeslam/tracking/track_result.h"

namespace eyeslam::support {

/// A retina under even light, larger than any view. Views at whole px have an exactly known pose without any
/// interpolation; every view has noise of its own, as of a camera.
class MovingRetina {
 public:
  static constexpr double kNoise = 2.0;  ///< grey levels

  /// @param um_per_px  13 gives a view 320 px wide the retina of a microscope's
  explicit MovingRetina(double um_per_px = 13.0, std::uint64_t seed = 3)
  {
    simulation::ProceduralFundusOptions options;
    options.um_per_px = um_per_px;
    simulation::proceduralFundus(options, seed).bgr.convertTo(picture_, CV_32F, kWhite);
    // Among the vessels between disc and macula.
    middle_ = {picture_.cols / 2, picture_.rows / 2};
  }

  /// The same retina at `factor` times as many px.
  MovingRetina enlarged(double factor) const
  {
    MovingRetina larger(*this);
    cv::resize(picture_, larger.picture_, {}, factor, factor, cv::INTER_CUBIC);
    larger.middle_ = {larger.picture_.cols / 2, larger.picture_.rows / 2};
    return larger;
  }

  /// How far a view of this size may be shifted in x and y, px.
  cv::Size reach(const cv::Size& size) const
  {
    return {(picture_.cols - size.width) / 2, (picture_.rows - size.height) / 2};
  }

  /// The view whose map pose is (shift, 0 deg) when a view at (0, 0) was frame 0.
  cv::Mat view(const cv::Size& size, const cv::Point& shift, unsigned noise_seed) const
  {
    return photograph(light(size, shift), noise_seed);
  }

  /// The same, moving by `smear` px while the shutter is open; at `shift` in the middle of that time.
  cv::Mat smeared(const cv::Size& size, const cv::Point& shift, const cv::Point& smear, unsigned noise_seed) const
  {
    const int steps = std::max(std::abs(smear.x), std::abs(smear.y));
    cv::Mat sum(size, CV_32FC3, cv::Scalar::all(0.0));
    for (int k = 0; k <= steps; ++k) {
      const double along = static_cast<double>(k) / steps - 0.5;
      sum += light(size, shift + cv::Point(cvRound(along * smear.x), cvRound(along * smear.y)));
    }
    return photograph(sum / (steps + 1), noise_seed);
  }

  /// The view at any pose (contracts, section 1), by cubic interpolation in 1/32 px.
  cv::Mat turned(const cv::Size& size, const retina::Pose2& map_T_frame, unsigned noise_seed) const
  {
    const Eigen::Matrix2d linear = map_T_frame.linear();
    const Eigen::Vector2d centre((size.width - 1) / 2.0, (size.height - 1) / 2.0);
    const cv::Point corner = cornerOf(size);
    const Eigen::Vector2d shift =
        centre + map_T_frame.translation() - linear * centre + Eigen::Vector2d(corner.x, corner.y);
    const cv::Matx23d picture_T_frame(linear(0, 0), linear(0, 1), shift.x(), linear(1, 0), linear(1, 1), shift.y());
    cv::Mat result;
    cv::warpAffine(picture_, result, picture_T_frame, size, cv::INTER_CUBIC | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REFLECT_101);
    return photograph(result, noise_seed);
  }

 private:
  static constexpr double kWhite = 230.0;  // grey level of white under this light

  cv::Point cornerOf(const cv::Size& size) const { return middle_ - cv::Point(size.width / 2, size.height / 2); }

  cv::Mat light(const cv::Size& size, const cv::Point& shift) const
  {
    return picture_(cv::Rect(cornerOf(size) + shift, size));
  }

  static cv::Mat photograph(const cv::Mat& light, unsigned noise_seed)
  {
    cv::RNG random(noise_seed + 1);
    cv::Mat grain(light.size(), CV_32FC3), photo;
    random.fill(grain, cv::RNG::NORMAL, 0.0, kNoise);
    cv::Mat(light + grain).convertTo(photo, CV_8U);
    return photo;
  }

  cv::Mat picture_;  // CV_32FC3, grey levels
  cv::Point middle_;
};

/// One retina for all tests of a program: it takes a while to grow.
inline const MovingRetina& smallRetina()
{
  static const MovingRetina retina;
  return retina;
}

inline std::string toString(const tracking::TrackResult& result)
{
  return result.tracked ? "tracked" : std::string(retina::word(result.reason));
}

/// Full-resolution px between where the image centre was put and where it was.
inline double centreError(const tracking::TrackResult& result, double x, double y)
{
  return std::hypot(result.map_T_frame.x - x, result.map_T_frame.y - y);
}

}  // namespace eyeslam::support
