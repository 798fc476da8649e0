// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace eyeslam::robot {

/// Where the tip may go: a cylinder about the null tip, along the shaft; m.
struct Workspace {
  double reach_lateral = 2e-3;  ///< radius
  double reach_axial = 2e-3;    ///< half of the height

  /// @param way  from the null tip; @param axis  of the shaft, unit vector
  /// @return  the way, shortened across and along the shaft to the cylinder
  Eigen::Vector3d shortened(const Eigen::Vector3d& way, const Eigen::Vector3d& axis) const;
};

/// What the program asks of the tip, turned into its goal step by step: a velocity is summed up, a position is taken.
/// The goal itself is held in the workspace, so nothing winds up at its edge. Manipulator frame, m, s.
class TipMotion {
 public:
  enum class Kind { rest, velocity, position, deflection };

  /// From here; the tip rests.
  void startAt(const Eigen::Vector3d& tip);
  void setVelocity(const Eigen::Vector3d& velocity);
  void setPosition(const Eigen::Vector3d& tip);
  /// From the null: the tip goes with the hand.
  void setDeflection(const Eigen::Vector3d& way);
  void rest() { setVelocity(Eigen::Vector3d::Zero()); }

  /// @return where the tip should be now
  const Eigen::Vector3d& step(double time_s, const Eigen::Vector3d& null, const Eigen::Vector3d& axis,
                              const Workspace& workspace);

  Kind kind() const { return kind_; }
  double speed() const { return velocity_.norm(); }
  const Eigen::Vector3d& goal() const { return goal_; }
  /// What was asked for lies beyond the workspace.
  bool isSaturated() const { return saturated_; }

 private:
  Kind kind_ = Kind::rest;
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_ = Eigen::Vector3d::Zero();  // of the tip, or from the null
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  bool saturated_ = false;
};

}  // namespace eyeslam::robot
