// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "eyeslam/simulation/hand.h"
#include "eyeslam/simulation/random.h"
#include "eyeslam/simulation/retina_motion_options.h"
#include "eyeslam/simulation/shaped_noise.h"

namespace eyeslam::simulation {

/// How the instrument turns the eye: the port is displaced, the globe follows with a lag, the retina the other way.
/// retina = -G lag(port), G a gain and a turn that differ from eye to eye and wander. Source: loop study, section 1.
class PortCoupling {
 public:
  /// @param speed  RMS speed that the port's own noise gives the retina, m/s
  PortCoupling(const RetinaMotionOptions& options, double speed, std::uint64_t seed, double period_s);

  /// One period later.
  /// @param pulled  where jerks of the instrument want the retina, m: the port goes where that needs it to
  void step(const HandState& hand, const Eigen::Vector2d& pulled);
  /// The lag forgets what it has seen: as if the present displacement had lasted for ever.
  void settle();

  const Eigen::Vector2d& port() const { return port_; }      ///< displacement, world's x and y, m
  const Eigen::Vector2d& retina() const { return retina_; }  ///< what it makes of the retina, m
  double gain() const { return gain_; }                      ///< of this eye, before it wanders
  double turn() const { return turn_; }                      ///< rad

 private:
  Eigen::Matrix2d wanderedGain() const;
  void wander();

  double tremor_part_, travel_part_;
  std::array<ShapedNoise, 2> noise_;
  std::array<FilterCascade, 2> globe_;
  double noise_rms_ = 0.0, gain_ = 0.0, turn_ = 0.0;
  double wander_rms_, wander_kept_, wander_eased_;
  std::array<double, 2> rough_{}, wander_{};  // of gain (share) and turn (rad); before and after smoothing
  Random random_;
  Eigen::Vector2d port_ = Eigen::Vector2d::Zero(), retina_ = Eigen::Vector2d::Zero();
};

}  // namespace eyeslam::simulation
