// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "eyeslam/replay/logged_scene.h"

namespace eyeslam::replay {

/// A frame with everything that its log tells of it: the published vessels, the plan's targets and the zones at the
/// localized pose, the instrument as vision saw it, the tip, the hand and the goal as the registration projects them,
/// what the operator wants, and, below, what the servo does and why. About 6 ms a frame of 800 x 608.
class ScenePicture {
 public:
  /// @param image   8 bit, BGR or grey; all of one size
  /// @param number  of the frame's pose, from 0
  /// @param time_s  since the log's first event, of the middle of the exposure
  /// @param known   its pose is the scene's; else nothing but the frame is drawn
  /// @return BGR, of even width and height; valid until the next call
  const cv::Mat& draw(const cv::Mat& image, std::int64_t number, double time_s, const LoggedScene& scene, bool known);

 private:
  void layOut(const cv::Mat& image);
  cv::Point2d onCanvas(cv::Point2d image_px) const;
  void drawVessels(const LoggedScene& scene);
  void drawPlan(const LoggedScene& scene);
  void drawWish(const LoggedScene& scene);
  void drawInstrument(const LoggedScene& scene);
  void drawManipulator(const LoggedScene& scene);
  void writeState(std::int64_t number, double time_s, const LoggedScene& scene, bool known);
  int write(const std::string& text, int x, int line, const cv::Scalar& colour);
  void drawTarget(const burn_target_t& target, cv::Point2d at, double radius);

  cv::Size size_;          // of the image
  int enlarged_ = 1;       // times, for small images
  cv::Mat canvas_, view_;  // whole, and the part of the frame
  cv::Mat warped_, mask_, tint_;
  cv::Matx23d image_T_map_;
};

}  // namespace eyeslam::replay
