// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "eyeslam/trials/jump_recovery.h"

namespace eyeslam::trials {

/// What a trial came to; a sample a millisecond.
struct TipErrors {
  std::vector<double> errors_m;
  std::vector<bool> calm;             ///< the same samples: not within 150 ms of a jerk or saccade
  std::vector<Jump> jumps;            ///< jerks and saccades
  std::vector<Eigen::Vector3d> path;  ///< of the tip, retina frame, m
  double saturated_fraction = 0.0;
};

/// Follows the tip through a trial, by the simulation's truth.
class TipJudge {
 public:
  /// @param settling_s  before anything counts
  explicit TipJudge(double settling_s);

  struct Sample {
    double t_s = 0.0;
    Eigen::Vector3d tip = Eigen::Vector3d::Zero();     ///< retina frame, m
    double error = 0.0;                                ///< m
    bool jumping = false;                              ///< a jerk or saccade is in progress
    Eigen::Vector2d jumped = Eigen::Vector2d::Zero();  ///< what they have moved so far, m
    bool saturated = false;
  };
  void step(const Sample& sample);
  /// A frame exposed at this instant was refused, or wrong.
  void spoilt(double t_s) { recovery_.spoilt(t_s); }

  /// At the end.
  TipErrors result() const;

 private:
  double settling_s_;
  JumpRecovery recovery_;
  double calm_from_s_ = 0.0;
  double saturated_ = 0.0;
  TipErrors result_;
};

}  // namespace eyeslam::trials
