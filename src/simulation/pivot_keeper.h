// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "eyeslam/simulation/micron_controller_options.h"
#include "eyeslam/simulation/micron_model.h"

namespace eyeslam::simulation {

/// The other two degrees of freedom of the tip's pose: moves the shaft's point at the pivot, with the same actuators
/// that move the tip, so that the shaft goes through a remote centre of motion; without one the shaft stays parallel to
/// the handle. World's frame, m. Never allocates.
class PivotKeeper {
 public:
  PivotKeeper(const PivotKeeperOptions& options, const MicronOptions& plant, double ramp_s, double speed,
              std::uint64_t seed, double period_s);

  /// One period later.
  /// @param null        true null of the tip
  /// @param shaft       true unit vector up the handle's shaft
  /// @param deflection  commanded to the tip
  /// @param pivot       where the shaft is to go through; none: parallel to the handle
  void step(const Eigen::Vector3d& null, const Eigen::Vector3d& shaft, const Eigen::Vector3d& deflection,
            const std::optional<Eigen::Vector3d>& pivot);
  /// Without power it stays as it is against the handle.
  void stepUnpowered(const Eigen::Vector3d& null, const Eigen::Vector3d& shaft);

  /// As MicronModel::boundSpeed, so that the shaft's point keeps pace with the tip.
  void boundSpeed(double speed, const Eigen::Vector3d& hand) { plant_.boundSpeed(speed, hand); }

  /// The truth: the shaft's point.
  const Eigen::Vector3d& point() const { return plant_.tip(); }
  const MicronReading& reading() const { return plant_.state(); }
  /// A pivot is asked for.
  bool isAsked() const { return asked_; }
  const Eigen::Vector3d& pivot() const { return pivot_; }
  /// The manipulator cannot tilt as far as the pivot needs it.
  bool isLimited() const { return limited_; }
  /// The ramp to the pivot is over.
  bool isThere() const { return share_ >= 1.0; }

 private:
  Eigen::Vector3d wanted(const Eigen::Vector3d& shaft, const Eigen::Vector3d& deflection);
  void move(const Eigen::Vector3d& null, const Eigen::Vector3d& shaft);

  double tilt_, ramp_step_, pivot_step_;
  MicronModel plant_;
  double length_;  // from the tip to the shaft's point, along the handle's shaft
  bool asked_ = false, limited_ = false;
  double share_ = 0.0;
  Eigen::Vector3d pivot_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d command_ = Eigen::Vector3d::Zero();
};

}  // namespace eyeslam::simulation
