// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "eyeslam/simulation/random.h"
#include "eyeslam/simulation/retina_motion_options.h"

namespace eyeslam::simulation {

/// Jerks and saccades: steps (smoothstep in time) at random instants, in random directions, one after the other.
/// Beyond the options' reach they go back towards the start.
class EyeJerks {
 public:
  EyeJerks(const RetinaMotionOptions& options, std::uint64_t seed);

  /// What all jerks have moved at an instant; instants do not go back.
  void advance(double t_s);

  const Eigen::Vector2d& ownWay() const { return own_way_; }    ///< m: the eye's own
  const Eigen::Vector2d& toolWay() const { return tool_way_; }  ///< m: those that the instrument pulls the eye to
  double theta() const { return theta_; }
  bool inProgress() const { return under_way_; }

 private:
  struct Jerk {
    double start_s = 0.0;
    Eigen::Vector2d way = Eigen::Vector2d::Zero();
    double theta = 0.0;
    bool by_tool = false;
  };

  Jerk drawn(double earliest_s);

  double rate_, shortest_, longest_, duration_s_, turn_, reach_, tool_share_;
  Random random_;
  Jerk jerk_;  // the next one, or the one under way
  Eigen::Vector2d own_done_ = Eigen::Vector2d::Zero(), tool_done_ = Eigen::Vector2d::Zero();  // by finished jerks
  double theta_done_ = 0.0;
  Eigen::Vector2d own_way_ = Eigen::Vector2d::Zero(), tool_way_ = Eigen::Vector2d::Zero();
  double theta_ = 0.0;
  bool under_way_ = false;
};

}  // namespace eyeslam::simulation
