// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "eyeslam/simulation/micron_options.h"
#include "eyeslam/simulation/random.h"
#include "eyeslam/simulation/shaped_noise.h"

namespace eyeslam::simulation {

/// What the manipulator measures at an instant; m.
struct MicronReading {
  std::int64_t periods = 0;  ///< since the start, when it was measured
  Eigen::Vector3d null = Eigen::Vector3d::Zero();
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< without the needle's bending, which nothing measures
  Eigen::Vector2d port = Eigen::Vector2d::Zero();
};

/// What bounded the deflection since the step before.
struct MicronLimits {
  bool lateral = false, axial = false;  ///< the command is out of reach; without a known shaft always both
  bool speed = false, acceleration = false;
};

/// The manipulator in the hand: its tip is the hand's null + a deflection that follows its command late, as a damped
/// oscillator of bounded speed, acceleration and reach. World's frame, m. Source: loop study, section 1.
///
///   MicronModel micron({}, seed);
///   each millisecond:
///     micron.step(hand.null, port);
///     servo reads micron.state(), then micron.commandDeflection(d) or micron.commandTip(goal)
///
/// Never allocates.
class MicronModel {
 public:
  MicronModel(const MicronOptions& options, std::uint64_t seed, double period_s = 1e-3);

  /// One period later: the hand is here, the last command still holds.
  void step(const Eigen::Vector3d& null, const Eigen::Vector2d& port);
  /// The reach is a cylinder about the null along this direction; before the first call it is a ball.
  /// @param shaft  unit vector
  void setShaft(const Eigen::Vector3d& shaft) { shaft_ = shaft; }
  /// Bounds the tip's speed besides the deflection's, from now on. It is the motion that is bounded, not the command:
  /// one that leads a slow plant changes faster than the tip.
  /// @param hand  velocity at which the hand carries the null, as measured, m/s
  void boundSpeed(double speed, const Eigen::Vector3d& hand)
  {
    tip_speed_ = speed;
    hand_velocity_ = hand;
  }
  void commandDeflection(const Eigen::Vector3d& deflection);
  /// The controller subtracts the null that it measures at each step itself.
  void commandTip(const Eigen::Vector3d& goal);

  /// The truth.
  const Eigen::Vector3d& tip() const { return tip_; }
  Eigen::Vector3d deflection() const { return position_.cwiseProduct(gain_); }
  bool isSaturated() const { return limits_.lateral || limits_.axial; }
  const MicronLimits& limits() const { return limits_; }
  /// What it measures at this very instant: its own controller's.
  const MicronReading& fresh() const { return readings_[static_cast<std::size_t>(periods_) % kReadings]; }
  /// What a servo hears now, as old as the options say.
  const MicronReading& state() const;
  /// Delay + 2 z / w, s: what a controller says of itself.
  double lead() const;

 private:
  static constexpr std::size_t kReadings = 16;
  static constexpr int kSubsteps = 10;
  static constexpr std::size_t kCommands = 512;  // of substeps

  void measure(const Eigen::Vector3d& null, const Eigen::Vector2d& port);
  void actuate(const Eigen::Vector3d& target, double time_s);
  Eigen::Vector3d wanted() const;
  Eigen::Vector3d withinReach(const Eigen::Vector3d& deflection) const;
  MicronLimits outOfReach(const Eigen::Vector3d& deflection) const;

  MicronOptions options_;
  double period_s_, rate_;
  std::size_t delay_;  // substeps
  Random noise_;
  std::array<ShapedNoise, 3> bend_;
  Eigen::Vector3d gain_;
  std::array<MicronReading, kReadings> readings_{};
  std::array<Eigen::Vector3d, kCommands> commands_;
  std::size_t next_command_ = 0;
  std::int64_t periods_ = 0;
  Eigen::Vector3d command_ = Eigen::Vector3d::Zero();
  bool command_is_tip_ = false;
  Eigen::Vector3d shaft_ = Eigen::Vector3d::Zero();
  double tip_speed_ = std::numeric_limits<double>::infinity();
  Eigen::Vector3d hand_velocity_ = Eigen::Vector3d::Zero();
  MicronLimits limits_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero();
};

}  // namespace eyeslam::simulation
