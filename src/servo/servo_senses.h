// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "eyeslam/servo/burn_run.h"
#include "eyeslam/servo/guidance.h"
#include "eyeslam/servo/pivot_estimator.h"
#include "eyeslam/servo/registration_desk.h"
#include "eyeslam/servo/servo_cycle.h"
#include "eyeslam/servo/servo_ears.h"
#include "eyeslam/servo/servo_options.h"
#include "eyeslam/servo/view_placement.h"

namespace eyeslam::servo {

/// From messages to what the loop calculates with: times by the receiver's clock, places in metres of the view, made by
/// one nominal scale; keeps camera, plane and port. A pose that is farther from the expected one than any eye moves is
/// not passed on. Never throws, never allocates.
class ServoSenses {
 public:
  /// @param ears, cycle  must outlive it
  ServoSenses(const ServoOptions& options, const ServoEars& ears, ServoCycle& cycle);

  /// What came since the last cycle, for `ServoCycle::observe`. @param now  monotonic, us
  /// @param prepared_um_per_px  the scale that vessels and plan were prepared with; 0: none
  const CycleInput& take(std::int64_t now, double prepared_um_per_px) noexcept;

  RegistrationDesk& desk() noexcept { return desk_; }
  const RegistrationDesk& desk() const noexcept { return desk_; }
  /// Of the port; none where it is not known, or not to be kept.
  std::optional<Eigen::Vector3d> pivot() const noexcept;
  RetinaFrame frame() const noexcept { return {map_id_, scale_.um_per_px, views_}; }
  /// A new pose is in use in this cycle.
  bool poseCame() const noexcept { return pose_came_; }
  /// Mid-exposure of the newest pose in use, by its sender's clock; 0 = none.
  std::int64_t utimeImage() const noexcept { return utime_image_; }
  /// Why no pose can be used: no_pose, pose_stale, pose_jumped (in this cycle); none.
  retina::Reason retina() const noexcept;
  /// Unit vector along the shaft, towards the tip, manipulator frame; zero before any state.
  const Eigen::Vector3d& shaft() const noexcept { return shaft_; }

  /// What burning wants to know of picture and instrument; the rest of the input is the caller's.
  void describe(const Outlook& outlook, BurnInput& input) const noexcept;

 private:
  void takeState() noexcept;
  void takePose() noexcept;
  void takeTip() noexcept;
  bool jumpedTooFar(const SeenPose& pose) const noexcept;
  void placeView(double prepared_um_per_px) noexcept;
  double poseError(const Eigen::Vector2d& place) const noexcept;
  double retinaSpeed(const Outlook& outlook) const noexcept;
  double metresPerPx() const noexcept { return 1e-6 * scale_.um_per_px; }

  const ServoOptions& options_;
  const ServoEars& ears_;
  ServoCycle& cycle_;
  RegistrationDesk desk_;
  PivotEstimator pivot_;
  ViewScale scale_;                           // that the view's metres are made of; 0 = nothing is placed yet
  std::int64_t adoptions_ = 0, refined_ = 0;  // of the desk, in the present placement
  std::int64_t views_ = 0;                    // placed anew so far
  CycleInput input_;
  bool pose_jumped_ = false, pose_came_ = false;
  std::int64_t states_ = 0, poses_ = 0, tips_ = 0;  // taken
  std::int64_t map_id_ = 0, utime_image_ = 0;
  std::int64_t pose_came_at_ = 0;  // monotonic, us; 0 = never
  SeenPose pose_;                  // the newest in use
  Eigen::Vector3d shaft_ = Eigen::Vector3d::Zero();
};

}  // namespace eyeslam::servo
