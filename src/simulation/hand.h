// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "eyeslam/simulation/hand_tremor.h"
#include "eyeslam/simulation/surgeon.h"

namespace eyeslam::simulation {

struct HandOptions {
  HandTremorOptions tremor;
  SurgeonOptions surgeon;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    visitor.group("tremor", self.tremor);
    visitor.group("surgeon", self.surgeon);
  }
};

/// Where a hand is, in the world's frame; m.
struct HandState {
  Eigen::Vector3d null = Eigen::Vector3d::Zero();    ///< where it carries the manipulator's null
  Eigen::Vector3d travel = Eigen::Vector3d::Zero();  ///< of the surgeon's will since the start
  Eigen::Vector3d tremor = Eigen::Vector3d::Zero();  ///< the tremor alone
};

/// A surgeon's hand at 1 kHz: what he means to do (`Surgeon`) and what he does besides (`HandTremor`).
///
///   Hand hand({}, start, seed);
///   RetinaMotion retina(retinaMotionOptions("in_situ"), seed);
///   each millisecond:
///     const HandState& held = hand.step({target, path_velocity, tip, null}, HandTremor::Support::fixture);
///     const RetinaState& moved = retina.step(held);   // the hand turns the eye about the port
class Hand {
 public:
  Hand(const HandOptions& options, const Eigen::Vector3d& start, std::uint64_t seed, double period_s = 1e-3);

  /// One period later.
  const HandState& step(const SurgeonView& view, HandTremor::Support support);
  const HandState& state() const { return state_; }
  const HandTremor& tremor() const { return tremor_; }

 private:
  Eigen::Vector3d start_;
  Surgeon surgeon_;
  HandTremor tremor_;
  HandState state_;
};

}  // namespace eyeslam::simulation
