// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "eyeslam/simulation/eye_camera_options.h"
#include "eyeslam/simulation/microscope.h"
#include "eyeslam/simulation/random.h"
#include "eyeslam/simulation/recorded_view.h"
#include "eyeslam/simulation/retina_pose.h"

namespace eyeslam::simulation {

/// All that a frame shows, as a value: it may be rendered later and in another thread.
struct FrameDue {
  int frame = 0;                       ///< from 0
  double t_s = 0.0;                    ///< middle of the exposure, since the start
  std::int64_t utime = 0;              ///< the same, us since 1970
  double exposure = 0.0;               ///< s
  RecordedView view;                   ///< map_T_frame during the exposure, the picture's wandering in it
  ToolInView tool;                     ///< mean over the exposure
  std::vector<cv::Point2d> burns_map;  ///< all so far, in their order, map px
  bool repeats = false;                ///< the camera is stuck: the picture before once more
};

/// What is before the camera at an instant; world's frame, m.
struct SceneNow {
  RetinaPose world_T_retina;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  Eigen::Vector3d shaft = -Eigen::Vector3d::UnitZ();  ///< unit vector from the tip up the shaft
  Eigen::Vector3d spot = Eigen::Vector3d::Zero();     ///< where the beam meets the retina
  bool aiming = false, emitting = false;
};

/// Exposes frames: gathers the world, a millisecond a call, and says when a frame's exposure is over. The camera looks
/// along the world's z; px = world's x and y / m per px, plus a slow wandering of the picture.
class FrameShutter {
 public:
  FrameShutter(const EyeCameraOptions& options, std::uint64_t seed, double period_s = 1e-3);

  /// One period later; the first call is t = 0.
  void expose(const SceneNow& scene);
  /// The frame whose exposure ended since the last call, at most one; `utime` and the burns are the caller's to fill.
  std::optional<FrameDue> due();

  /// How far the picture has wandered, m.
  const Eigen::Vector2d& picture() const { return picture_; }
  double time() const { return t_s_; }

 private:
  struct Sum {
    Eigen::Vector3d tip = Eigen::Vector3d::Zero(), shaft = Eigen::Vector3d::Zero(), spot = Eigen::Vector3d::Zero();
    double aiming = 0.0, emitting = 0.0, count = 0.0;
  };

  double middle() const { return frame_ / fps_; }
  cv::Point2d pixel(const Eigen::Vector3d& world) const;
  ToolInView toolInView() const;
  void wander();

  cv::Size size_;
  double fps_, exposure_, period_s_, m_per_px_, drift_, drift_kept_;
  Random random_;
  RecordedView view_;
  Eigen::Vector2d picture_ = Eigen::Vector2d::Zero();
  Sum sum_;
  int frame_ = 0;
  double t_s_ = 0.0;
  std::int64_t periods_ = -1;
};

}  // namespace eyeslam::simulation
