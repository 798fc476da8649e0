// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "eyeslam/simulation/body_cycle.h"
#include "eyeslam/simulation/eye_jerks.h"
#include "eyeslam/simulation/hand.h"
#include "eyeslam/simulation/port_coupling.h"
#include "eyeslam/simulation/retina_motion_options.h"
#include "eyeslam/simulation/retina_pose.h"
#include "eyeslam/simulation/shaped_noise.h"

namespace eyeslam::simulation {

/// The eye at an instant.
struct RetinaState {
  RetinaPose world_T_retina;
  Eigen::Vector2d port = Eigen::Vector2d::Zero();  ///< displacement of the port, world's x and y, m; a servo may see it
};

/// The retina under a hand, in metres, a step each millisecond: what a loop of eye, hand and manipulator needs.
/// (`EyeMotion` is the other model: px of a view, a function of time alone, for rendered videos in which no hand acts
/// on the eye. `RecordedView` lets this one drive the same renderer.)
///
/// -G lag(port displacement) + what no sensor sees + breathing + pulse + jerks, with a slow turn; along the line of
/// sight the breathing, the pulse and a rest. Parts of the hand's tremor and travel displace the port, so the eye
/// answers to the hand. The identity at the first step. Never allocates in `step`.
/// Source: loop study, section 1; facts, A6 and C5.
class RetinaMotion {
 public:
  /// @param centre  what the retina turns about, retina frame, m: the middle of the view
  RetinaMotion(const RetinaMotionOptions& options, std::uint64_t seed,
               const Eigen::Vector3d& centre = Eigen::Vector3d::Zero(), double period_s = 1e-3);

  /// One period later; the first call is the start.
  const RetinaState& step(const HandState& hand);
  const RetinaState& state() const { return state_; }

  /// RMS speed of this seed's smooth motion, without what tremor and travel of the hand add; m/s.
  double smoothSpeed() const { return speed_; }
  const PortCoupling& coupling() const { return coupling_; }
  const EyeJerks& jerks() const { return jerks_; }

 private:
  Eigen::Vector3d shift() const;
  void advance(const HandState& hand);

  double period_s_;
  double speed_;
  PortCoupling coupling_;
  EyeJerks jerks_;
  std::array<ShapedNoise, 2> unseen_noise_;
  ShapedNoise turn_noise_, axial_noise_;
  BodyCycle breath_, pulse_;
  Eigen::Vector3d breath_way_, pulse_way_;  // peaks, m
  double unseen_rms_, turn_rms_, axial_rms_;
  Eigen::Vector3d slow_ = Eigen::Vector3d::Zero();  // what noise moves at this instant, m
  double turn_ = 0.0;
  double t_ = 0.0;
  bool started_ = false;
  Eigen::Vector3d first_shift_ = Eigen::Vector3d::Zero();
  double first_turn_ = 0.0;
  RetinaState state_;
};

}  // namespace eyeslam::simulation
