// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/simulation/heard_command.h"
#include "eyeslam/simulation/micron_controller_options.h"
#include "eyeslam/simulation/micron_model.h"
#include "eyeslam/simulation/pivot_keeper.h"
#include "eyeslam/simulation/shelving_filter.h"

namespace eyeslam::simulation {

/// How the hand holds the manipulator at an instant; world's frame, m.
struct HeldManipulator {
  Eigen::Vector3d null = Eigen::Vector3d::Zero();
  Eigen::Vector3d shaft = -Eigen::Vector3d::UnitZ();  ///< unit vector from the null tip up the shaft
  Eigen::Vector2d port = Eigen::Vector2d::Zero();     ///< displacement of the port, x and y
};

/// The manipulator's own controller: obeys a motion command as long as that is in force, and else cancels tremor by its
/// own filter. Whatever changes, the tip's goal goes over within the ramp's time and below the speed that is allowed:
/// never a step. Commands and states speak the manipulator's frame, all else the world's. Never allocates.
///
///   MicronController controller({}, manipulator_T_world, seed);
///   each millisecond:
///     const MicronState& state = controller.step(held, heardOn(commands, monotonic_now));
///     states.publish(state, utime_now - controller.stateAge_us(), utime_now);
class MicronController {
 public:
  MicronController(const MicronControllerOptions& options, const Eigen::Isometry3d& manipulator_T_world,
                   std::uint64_t seed, double period_s = 1e-3);

  /// One period later. @return what it says of itself then
  const messaging::MicronState& step(const HeldManipulator& held, const HeardCommand<messaging::MicronCommand>& heard);
  const messaging::MicronState& state() const { return state_; }
  /// Of what a state measures, us.
  std::int64_t stateAge_us() const;

  /// Without power the motors stand still, the tip goes with the hand. Source: assumption (self-locking motors).
  void setPowered(bool powered) { powered_ = powered; }

  /// The truth, world's frame, m.
  const Eigen::Vector3d& tip() const { return tip_.tip(); }
  Eigen::Vector3d shaft() const;  ///< unit vector from the tip up the shaft
  bool isSaturated() const { return tip_.isSaturated(); }
  /// Distance of the shaft from the commanded pivot, 0 while none is kept.
  double pivotError() const;

 private:
  enum class Source { at_null, own_filter, tip_goal, deflection, no_power };

  Source chosen(const HeardCommand<messaging::MicronCommand>& heard);
  void change(Source source);
  double ramp();
  void begin(const HeldManipulator& held);
  void followGoal(const Eigen::Vector3d& wanted);
  void followDeflection(const Eigen::Vector3d& wanted);
  void steer(const messaging::MicronCommand* command);
  void move(const HeldManipulator& held, const HeardCommand<messaging::MicronCommand>& heard);
  void report(const HeardCommand<messaging::MicronCommand>& heard);
  messaging::ToolPose toolPose(const Eigen::Vector3d& tip, const Eigen::Vector3d& up, double along) const;

  MicronControllerOptions options_;
  Eigen::Isometry3d manipulator_T_world_;
  double period_s_;
  MicronModel tip_;
  PivotKeeper pivot_;
  ShelvingFilter filter_;
  bool powered_ = true;
  Source source_ = Source::own_filter;
  double ramp_s_ = 0.0;                             // since the source changed
  Eigen::Vector3d from_ = Eigen::Vector3d::Zero();  // where the goal was then
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();  // of the tip, that is followed
  Eigen::Vector3d null_ = Eigen::Vector3d::Zero();  // measured just now
  Eigen::Vector3d calm_null_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d deflection_ = Eigen::Vector3d::Zero();
  bool started_ = false;
  Eigen::Vector3d way_ = Eigen::Vector3d::UnitZ();  // of the tool at the start, manipulator's frame: fixes its roll
  messaging::MicronState state_;
};

}  // namespace eyeslam::simulation
