// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <visp3/core/vpColVector.h>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/core/vpImagePoint.h>
#include <visp3/core/vpMatrix.h>
#include <visp3/visual_features/vpGenericFeature.h>
#include <visp3/vs/vpServo.h>

#include <Eigen/Core>
#include <optional>

#include "eyeslam/retina/reason.h"
#include "eyeslam/robot/visual_servo_options.h"
#include "eyeslam/servo/camera_registration.h"

namespace eyeslam::robot {

/// Visual servoing (vpServo, eye to hand) of the tip, or of the aiming beam's spot, onto a point of the retina.
///
///   VisualServo servo;
///   servo.setRegistration(registration, plane);
///   for each frame:
///     servo.setTarget(target);                      // where the image shows the retina's point
///     servo.setSeen(tip);                           // where it shows the tip or the spot; image-based only
///     micron.get_fJe(fJe);
///     micron.setVelocity(vpRobot::REFERENCE_FRAME, servo.computeVelocity(micron.get_fMe(), fJe));
///
/// Features are in mm, so that one gain suits all: image-based two of the image, px x mm per px, by the affine camera
/// of the registration; and the height of the tip above the retina's plane, which the image does not show (hybrid
/// servoing, facts E4). Position-based the tip or spot in the manipulator's frame; for a spot again with the tip's
/// height. The error falls exponentially by vpAdaptiveGain; a velocity that is too large is shortened as a whole.
/// Nothing is summed up, so nothing winds up while the tip is held by a limit.
///
/// Instead of a velocity: 0 and a reason where the registration is bad (its own reason), nothing was seen (no_tip),
/// a number is none, or the features do not fix the tip (servo_singular). Never throws for what it is given. For the
/// camera's rate, outside the 1 kHz thread: vpServo allocates.
class VisualServo {
 public:
  /// @throws std::runtime_error for unknown words in the options
  explicit VisualServo(const VisualServoOptions& options = {});
  // vpServo keeps the addresses of its features.
  VisualServo(const VisualServo&) = delete;
  VisualServo& operator=(const VisualServo&) = delete;

  void setRegistration(const servo::Registration& registration, const servo::RetinaPlane& plane);
  /// Full-resolution px of the image (u = x, v = y).
  void setTarget(const vpImagePoint& target);
  /// The tip or the spot in the newest frame; used once.
  void setSeen(const vpImagePoint& seen);

  /// @param fMe  where the tip is in the manipulator's frame, z along the shaft
  /// @param fJe  6 x 3, as RobotMicron::get_fJe
  /// @return  velocity of the tip, 3 numbers, m/s, manipulator's frame; zeros where there is a reason
  vpColVector computeVelocity(const vpHomogeneousMatrix& fMe, const vpMatrix& fJe);

  retina::Reason getReason() const { return reason_; }
  /// Current minus desired features, mm; of the last velocity.
  const vpColVector& getError() const { return error_; }
  /// The velocity was shortened.
  bool isSaturated() const { return saturated_; }
  /// Where the beam along the shaft meets the plane, manipulator frame, m; none where it does not.
  static std::optional<Eigen::Vector3d> spotOf(const Eigen::Isometry3d& fMe, const servo::RetinaPlane& plane);

 private:
  using Features = Eigen::Vector3d;
  using Interaction = Eigen::Matrix<double, 3, 6>;
  struct Sight {
    Features current = Features::Zero(), desired = Features::Zero();  // mm
    Interaction motion = Interaction::Zero();                         // mm/s of the features per twist of the tool
  };

  retina::Reason look(const Eigen::Isometry3d& fMe, Sight& sight) const;
  Eigen::Matrix<double, 3, 6> pointMotion(const Eigen::Isometry3d& fMe, const Eigen::Vector3d& point) const;
  retina::Reason lawOf(const Sight& sight, const vpMatrix& fJe, Eigen::Vector3d& velocity);
  retina::Reason compute(const vpHomogeneousMatrix& fMe, const vpMatrix& fJe, Eigen::Vector3d& velocity);

  VisualServoOptions options_;
  bool by_image_, of_spot_;
  servo::Registration registration_;
  servo::RetinaPlane plane_;
  double mm_per_px_ = 0.0;
  std::optional<Eigen::Vector2d> target_px_, seen_px_;
  vpGenericFeature current_{3}, desired_{3};
  vpServo task_;
  vpColVector error_ = vpColVector(3);
  retina::Reason reason_ = retina::Reason::not_registered;
  bool saturated_ = false;
};

}  // namespace eyeslam::robot
