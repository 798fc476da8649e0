// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/simulation/camera_options.h"
#include "eyeslam/simulation/random.h"
#include "eyeslam/simulation/retina_pose.h"

namespace eyeslam::simulation {

/// What camera and tracker make of a frame.
struct TrackedFrame {
  double mid_exposure_s = 0.0;
  double ready_s = 0.0;                           ///< when the pose is there
  bool tracked = false;                           ///< false: refused, or an outlier that was noticed
  bool outlier = false;                           ///< truth, for scores
  retina::Pose2 view_T_retina;                    ///< m, rad, about the image centre; mean over the exposure
  Eigen::Vector2d tip = Eigen::Vector2d::Zero();  ///< view, m; mean over the exposure
};

/// Camera and tracker without pictures: poses and tips as late, as rare and as wrong as the options say. The view is
/// the world's x and y, plus a slow wandering of the picture against the manipulator. Never allocates.
///
///   TrackerModel tracker(timing, errors, registration, seed, centre);
///   each millisecond:
///     tracker.expose(t_s, retina.world_T_retina, micron.tip());
///     if (const auto frame = tracker.ready(t_s)) servo.see(*frame);
class TrackerModel {
 public:
  /// @param centre  of the image, m
  TrackerModel(const CameraTimingOptions& timing, const TrackerModelOptions& errors,
               const RegistrationErrorOptions& registration, std::uint64_t seed, const Eigen::Vector2d& centre,
               double period_s = 1e-3);

  /// What is before the camera at an instant; instants rise by one period.
  void expose(double t_s, const RetinaPose& world_T_retina, const Eigen::Vector3d& tip);
  /// The frame that became ready since the last call, at most one.
  std::optional<TrackedFrame> ready(double t_s);

  /// How far the picture has wandered, view, m.
  const Eigen::Vector2d& picture() const { return picture_.value; }
  double exposure() const { return exposure_; }
  double latest() const { return latency_high_; }
  double interval() const { return interval_; }

 private:
  static constexpr std::size_t kWaiting = 64;

  struct Wander {
    double kept, rms;
    Eigen::Vector2d value = Eigen::Vector2d::Zero();
    void step(Random& random);
  };
  struct Sum {
    Eigen::Vector3d pose = Eigen::Vector3d::Zero();
    Eigen::Vector2d tip = Eigen::Vector2d::Zero(), first = Eigen::Vector2d::Zero(), last = Eigen::Vector2d::Zero();
    double count = 0.0;
  };

  void finish();

  TrackerModelOptions errors_;
  Eigen::Vector2d centre_;
  double interval_, exposure_, latency_low_, latency_high_, period_s_;
  Random random_;
  Wander bias_, picture_;
  double mid_exposure_;  // of the frame being exposed, or the next one
  Sum sum_;
  std::array<TrackedFrame, kWaiting> waiting_{};
  std::size_t first_ = 0, count_ = 0;
};

/// manipulator_T_view of a wrong registration, in the plane: a turn and a scale about `centre`, drawn from the seed.
/// The third column is the translation.
Eigen::Matrix<double, 2, 3> wrongRegistration(const RegistrationErrorOptions& options, std::uint64_t seed,
                                              const Eigen::Vector2d& centre);

}  // namespace eyeslam::simulation
