// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <visp3/core/vpColVector.h>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/core/vpMatrix.h>
#include <visp3/robot/vpRobot.h>

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/robot/robot_micron_options.h"
#include "eyeslam/robot/tip_motion.h"
#include "eyeslam/servo/pivot_estimator.h"

namespace eyeslam::robot {

/// Micron as a robot of ViSP: any program that knows vpRobot moves the tip, over the same messages as the servo.
///
///   messaging::Link link("", session, key);
///   RobotMicron micron(link, [] { return messaging::ReceiveTime{monotonic_us(), utime_us()}; });
///   micron.init();
///   micron.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
///   for each frame: micron.setVelocity(vpRobot::REFERENCE_FRAME, v);      // 3 numbers, m/s
///
/// Three degrees of freedom: the tip's place, m, in the manipulator's frame. The tool's orientation is the hand's, or,
/// where a remote centre of motion is known (estimated from the hand's motion, or by setPivot), such that the shaft
/// goes through it. Frames:
///   REFERENCE_FRAME     the tip in the manipulator's frame; positions as (t, theta u), of which only t is commanded
///   JOINT_STATE         its deflection from the null tip, in the manipulator's axes. A *position* is held from the
///                       null, so the tip goes with the hand; under all else the hand's tremor stays cancelled
///   END_EFFECTOR_FRAME  the tool's own axes, z along the shaft; velocities and displacements only
/// The others throw. Velocities are shortened as a whole to the smallest of setMaxTranslationVelocity() (20 mm/s at the
/// start), the option and the controller's own; the goal stays in a cylinder about the null tip.
///
/// **It moves only while the program calls.** There is no thread: every call below but the getters of a field hears the
/// controller and renews the command, which lapses 50 ms later; keepAlive() does nothing else. A program that stalls,
/// throws or ends so hands the tip back to the controller's own tremor filter, gently. Nor does setPosition() wait:
/// go on calling. A velocity lasts 200 ms unless set again. After
/// a pause of the program or a silence of the controller what was asked for is forgotten: the tip rests where it is
/// then.
///
/// Throws vpRobotException: no state heard for 50 ms (communicationError), actuators off or pose not measured
/// (lowLevelError), wrong frame, size or state, a number that is none (the tip then rests), a position out of reach.
/// One thread, that which drains the link; ViSP's linear algebra is not used. Not for the 1 kHz loop: it allocates.
class RobotMicron : public vpRobot {
 public:
  using Clock = std::function<messaging::ReceiveTime()>;

  /// @param link   outlives this
  /// @param clock  the program's: time is read through it alone, so that a simulation may run in lock step
  /// @throws std::runtime_error as messaging::Subscription
  RobotMicron(messaging::Link& link, Clock clock, const RobotMicronOptions& options = {});
  RobotMicron(const RobotMicron&) = delete;
  RobotMicron& operator=(const RobotMicron&) = delete;

  /// Waits for the controller, at most `wait_ms`; needed only where the program does not wait itself.
  void init() override;

  /// Stop (the controller cancels tremor), velocity or position control (the tip rests at first).
  vpRobotStateType setRobotState(vpRobotStateType state) override;
  void setVelocity(vpControlFrameType frame, const vpColVector& velocity) override;
  /// @param position  3 numbers, or in the REFERENCE_FRAME as getPosition() gives them
  void setPosition(vpControlFrameType frame, const vpColVector& position) override;
  void getPosition(vpControlFrameType frame, vpColVector& position) override;
  using vpRobot::getPosition;
  /// Since the last call, whatever its frame; 0 at the first. 6 numbers (t, theta u), in JOINT_STATE 3.
  void getDisplacement(vpControlFrameType frame, vpColVector& displacement) override;
  /// 6 x 3: velocity of the tip and rate of turn, in the manipulator's axes, of the tip's velocity there.
  void get_fJe(vpMatrix& fJe) override;
  /// The same in the tool's own axes.
  void get_eJe(vpMatrix& eJe) override;
  /// Where the tip is, z along the shaft.
  vpHomogeneousMatrix get_fMe();

  /// Hears the controller and renews the command; never throws for what it hears: see getReason().
  void keepAlive();

  /// A remote centre of motion that is known better than the hand shows it, manipulator frame, m; none: estimated.
  void setPivot(const std::optional<Eigen::Vector3d>& pivot) { given_pivot_ = pivot; }
  /// The one in use.
  std::optional<Eigen::Vector3d> getPivot() const;
  /// The newest state of the controller; null before the first.
  const messaging::MicronState* getState() const { return states_.latest(); }
  /// Why the tip is not moved, or the controller's reason not to follow; none when all is well.
  retina::Reason getReason() const;
  /// The goal lies on the edge of the workspace, for more was asked.
  bool isSaturated() const { return motion_.isSaturated(); }

 private:
  const messaging::MicronState& hear();
  void requireState(vpRobotStateType state, const char* what);
  retina::Reason whyNot(const messaging::ReceiveTime& now) const;
  void command(const messaging::ReceiveTime& now);
  void publish(const messaging::MicronCommand& command, const messaging::ReceiveTime& now);
  messaging::MicronCommand following(const messaging::MicronState& state) const;
  Workspace workspace(const messaging::MicronState& state) const;
  double speedBound(const messaging::MicronState& state) const;

  messaging::Link& link_;
  Clock clock_;
  RobotMicronOptions options_;
  servo::PivotEstimator pivot_;
  messaging::Subscription<micron_state_t> states_;
  messaging::Publisher<micron_command_t> commands_;
  std::optional<Eigen::Vector3d> given_pivot_;
  TipMotion motion_;
  bool started_ = false;           // the motion starts from a state
  std::int64_t last_step_ = 0;     // monotonic, us
  std::int64_t velocity_set_ = 0;  // monotonic, us
  retina::Reason reason_ = retina::Reason::no_state;
  std::optional<messaging::MicronState> displaced_from_;
};

}  // namespace eyeslam::robot
