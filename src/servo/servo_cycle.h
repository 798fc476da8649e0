// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "eyeslam/fixtures/tremor_filter.h"
#include "eyeslam/servo/hand_over.h"
#include "eyeslam/servo/integral_action.h"
#include "eyeslam/servo/motion_limiter.h"
#include "eyeslam/servo/null_predictor.h"
#include "eyeslam/servo/plant_inverse.h"
#include "eyeslam/servo/refusals.h"
#include "eyeslam/servo/registration_trim.h"
#include "eyeslam/servo/retina_predictor.h"
#include "eyeslam/servo/servo_cycle_options.h"
#include "eyeslam/servo/timed_ring.h"
#include "eyeslam/servo/view_placement.h"
#include "eyeslam/servo/view_pose.h"

namespace eyeslam::servo {

/// What the manipulator measured at an instant; manipulator frame, m.
struct ManipulatorState {
  std::int64_t utime = 0;
  Eigen::Vector3d null = Eigen::Vector3d::Zero();
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector2d> port;  ///< displacement of the port; none where it is not measured
};

/// What came in since the last cycle.
struct CycleInput {
  std::int64_t now = 0;
  std::optional<ManipulatorState> state;
  std::optional<SeenPose> pose;
  std::optional<SeenTip> tip;
};

/// What fixtures need: the hand and the retina at the time at which the command will have taken effect.
struct Outlook {
  std::int64_t utime = 0;                                 ///< that time
  double step_s = 0.0;                                    ///< since the last cycle
  ViewPose retina;                                        ///< predicted
  PredictedPose prediction;                               ///< the same with its uncertainty and age
  Eigen::Vector3d null_retina = Eigen::Vector3d::Zero();  ///< the hand's null, predicted; retina frame, m
  Eigen::Vector3d hand = Eigen::Vector3d::Zero();         ///< the null without its tremor; manipulator frame, m
  double state_age_s = 0.0;
  retina::Reason reason =
      retina::Reason::none;  ///< why there is no goal to be had: no_state, state_stale, no_pose, pose_stale
};

/// What goes to the controller; manipulator frame, m.
struct ServoCommand {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< deflection, or goal of the tip: by `NullAt`
  Eigen::Vector3d deflection = Eigen::Vector3d::Zero();  ///< that the tip is meant to have then
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();        ///< where the tip is meant to be at the outlook's time
  double share = 0.0;                                    ///< [0, 1], of the guidance in the goal; 0: the hand alone
  bool saturated = false;                                ///< the goal lies beyond the reach
  retina::Reason reason = retina::Reason::none;          ///< why the goal asked for was not followed
};

/// One cycle of the 1 kHz loop as a function of inputs and time; no clock, no thread, no message. Between its halves
/// the fixture turns the hand's place on the retina into the tip's:
///
///   ServoCycle cycle(options, placement);
///   each millisecond:
///     const Outlook& outlook = cycle.observe(input);
///     const Eigen::Vector3d goal = fixture(outlook.null_retina);      // retina frame
///     const ServoCommand& command = cycle.command(goal);
///
/// What is not guided follows the hand without its tremor. Whatever happens between guided and not, the goal keeps its
/// speed and acceleration within their limits. Refused inputs change nothing and are counted by reason. Never throws,
/// never allocates, about 5 us of CPU. Source: loop study, section 2.
class ServoCycle {
 public:
  static constexpr double kCarried_m = 300e-6;

  ServoCycle(const ServoCycleOptions& options, const ViewPlacement& placement);

  const Outlook& observe(const CycleInput& input) noexcept;
  /// The second half. @param goal_retina  of the tip. Where it is not finite, or the outlook has a reason, its share
  /// fades to 0 within a hand-over, and comes back likewise.
  /// @param share  [0, 1] that the caller gives it
  const ServoCommand& command(const Eigen::Vector3d& goal_retina, double share = 1.0) noexcept;
  /// The same for a goal in the manipulator's frame, for which the retina need not be known.
  const ServoCommand& commandTip(const Eigen::Vector3d& goal, double share = 1.0) noexcept;
  /// Instead of a command: nobody follows. The next command begins where the tip is then.
  void rest() noexcept;

  /// The registration was refined: the view's metres and centre are the same. What the trim knows is carried over, so
  /// that nothing moves; after a change of more than `kCarried_m` it starts anew.
  void setPlacement(const ViewPlacement& placement) noexcept;
  /// Another view: what was seen before is forgotten.
  void startView(const ViewPlacement& placement) noexcept;
  /// Another map: where the retina was seen before means nothing in it.
  void forgetRetina() noexcept { retina_ = RetinaPredictor(options_.retina); }

  /// Delay of the plant + 2 z / w, as the controller says (contracts, section 4); s.
  void setLead(double lead_s) noexcept;

  /// The newest measured tip where the camera should see it; view frame, m. Zero before any.
  Eigen::Vector2d tipInView() const noexcept
  {
    return state_ ? Eigen::Vector2d(toView(state_->tip).head<2>()) : Eigen::Vector2d::Zero();
  }

  /// A place, or a direction, of the manipulator's frame as the retina lay at an instant; retina frame, m.
  Eigen::Vector3d onRetina(const Eigen::Vector3d& place, std::int64_t utime) const noexcept;
  Eigen::Vector3d directionOnRetina(const Eigen::Vector3d& direction, std::int64_t utime) const noexcept;

  /// What the last cycle asked for.
  const ServoCommand& last() const noexcept { return command_; }
  const Refusals& refusals() const noexcept { return refusals_; }
  const RetinaPredictor& retina() const noexcept { return retina_; }
  const NullPredictor& hand() const noexcept { return hand_; }
  const RegistrationTrim& trim() const noexcept { return trim_; }
  const IntegralAction& integral() const noexcept { return integral_; }

 private:
  void take(const ManipulatorState& state) noexcept;
  void take(const SeenTip& tip) noexcept;
  retina::Reason whatIsMissing(std::int64_t now) const noexcept;
  void followHand() noexcept;
  void begin() noexcept;
  retina::Reason whyNotThere(const Eigen::Vector3d& wanted) const noexcept;
  const ServoCommand& steer(const Eigen::Vector3d& wanted, double share, retina::Reason why) noexcept;
  Eigen::Vector3d toView(const Eigen::Vector3d& manipulator) const noexcept;
  Eigen::Vector3d toManipulator(const Eigen::Vector3d& view) const noexcept;
  Eigen::Vector3d nullAt(std::int64_t utime) const noexcept;

  ServoCycleOptions options_;
  ViewPlacement placement_;
  Eigen::Affine3d view_T_manipulator_;
  NullPredictor hand_;
  RetinaPredictor retina_;
  RegistrationTrim trim_;
  IntegralAction integral_;
  MotionLimiter limiter_;
  PlantInverse plant_;
  fixtures::TremorFilter hand_filter_;
  HandOver trust_;                                   // in what guides
  Eigen::Vector3d aside_ = Eigen::Vector3d::Zero();  // of the hand, last wanted by what guides; manipulator frame
  Refusals refusals_;
  std::int64_t lead_ = 0;  // us
  bool null_at_controller_;
  std::optional<ManipulatorState> state_;
  TimedRing<Eigen::Vector3d, 128> goals_;  // by the time at which they hold
  bool started_ = false;                   // somebody follows
  std::int64_t now_ = 0;
  Outlook outlook_;
  ServoCommand command_;
};

}  // namespace eyeslam::servo
