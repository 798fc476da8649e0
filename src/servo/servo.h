// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/servo/burn_run.h"
#include "eyeslam/servo/calibration.h"
#include "eyeslam/servo/calibration_run.h"
#include "eyeslam/servo/guidance.h"
#include "eyeslam/servo/hand_over.h"
#include "eyeslam/servo/health_monitor.h"
#include "eyeslam/servo/operator_watch.h"
#include "eyeslam/servo/preparation.h"
#include "eyeslam/servo/servo_cycle.h"
#include "eyeslam/servo/servo_ears.h"
#include "eyeslam/servo/servo_options.h"
#include "eyeslam/servo/servo_senses.h"
#include "eyeslam/servo/status_report.h"
#include "eyeslam/servo/supervisor.h"

namespace eyeslam::servo {

/// The 1 kHz servo behind its messages: everything that is decided between what is heard and what is sent, the same in
/// a real-time program and in lock step. It hears MICRON_STATE, LASER_STATE, OPERATOR, RETINA_POSE, TOOL_TIP, and who
/// else speaks on its own channels; it sends MICRON_COMMAND, LASER_COMMAND, SERVO_STATUS and REGISTRATION.
///
///   Servo servo(options, link);
///   each millisecond: link.drain(now);
///                     if (prepared) done_with = servo.adopt(prepared);
///                     servo.cycle(now, timing);
///
/// Within a cycle nothing throws, allocates (but what LCM itself does to send) or blocks. Source: loop study, 2;
/// contracts, 4.
class Servo {
 public:
  /// @param link  must outlive it; whoever owns it drains it
  Servo(const ServoOptions& options, messaging::Link& link);
  // The subscriptions hold its address.
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;

  /// One cycle, after the link was drained with the same time.
  void cycle(const messaging::ReceiveTime& now, const CycleTiming& timing) noexcept;

  /// What was prepared outside the loop takes the place of what was. @return that, to be freed outside the loop
  std::shared_ptr<const Preparation> adopt(std::shared_ptr<const Preparation> preparation) noexcept;
  /// The camera and the retina's plane, by a calibration or from a file. @param utime  us since 1970, when estimated
  void adopt(const CalibrationResult& calibration, std::int64_t utime) noexcept;
  /// A sweep that is over and waits for `evaluate`, outside the loop; null when there is none.
  const CalibrationSamples* samples() const noexcept;
  /// Somebody has them.
  void samplesTaken() noexcept { calibration_.taken(); }

  /// From now on the human's wish counts as standby: the controller takes over, and then `motion()` is none.
  void close() noexcept { closes_ = true; }

  const messaging::ServoStatus& status() const noexcept { return report_.status(); }
  /// What was sent to the manipulator in the last cycle; none when nothing was.
  const std::optional<messaging::MicronCommand>& motion() const noexcept { return motion_; }
  /// What was burnt and may be: BURN_PLAN in force is `BurnLedger::describe`, which allocates, and so published by
  /// whoever owns the loop, beside it, at 1 Hz and when `ledger().changes()` has grown.
  const BurnLedger& ledger() const noexcept { return burning_.ledger(); }
  /// Why no plan is in force; none when one is.
  retina::Reason planReason() const noexcept { return burning_.planReason(); }
  const BurnRun& burning() const noexcept { return burning_; }
  const RegistrationDesk& registration() const noexcept { return senses_.desk(); }
  const ServoCycle& loop() const noexcept { return cycle_; }
  const ServoEars& ears() const noexcept { return ears_; }

 private:
  void run(const CycleTiming& timing);
  void fail() noexcept;
  void rearm() noexcept;

  bool hasState(const Outlook& outlook) const noexcept;
  bool wantsCalibration() const noexcept;
  LoopSigns signs(const Outlook& outlook) noexcept;
  void supervise(const Outlook& outlook);
  bool isGuided() const noexcept;
  void burn(const Outlook& outlook) noexcept;
  const ServoCommand& guide(const Outlook& outlook) noexcept;
  Eigen::Vector3d goalOf(const Outlook& outlook, double share) noexcept;
  std::optional<messaging::MicronMode> modeOf(const Outlook& outlook) const noexcept;
  retina::Reason whyNotObeyed() noexcept;
  void move(const Outlook& outlook);
  void publishMotion(messaging::MicronMode mode, const Eigen::Vector3d& goal);
  void publishLaser();
  void publishRegistration();
  void publishStatus(const CycleTiming& timing);

  ServoOptions options_;
  ServoEars ears_;
  messaging::Publisher<micron_command_t> motions_;
  messaging::Publisher<laser_command_t> lasers_;
  messaging::Publisher<servo_status_t> statuses_;
  messaging::Publisher<registration_t> registrations_;

  OperatorWatch operator_;
  HealthMonitor monitor_;
  Supervisor supervisor_;
  HandOver hand_over_;
  ServoCycle cycle_;
  ServoSenses senses_;
  Guidance guidance_;
  CalibrationRun calibration_;
  BurnRun burning_;
  StatusReport report_;
  std::shared_ptr<const Preparation> preparation_;  // shared with who made it and will free it

  messaging::ReceiveTime now_;
  Wish wish_;
  Health health_;
  bool closes_ = false;
  retina::Reason trouble_ = retina::Reason::none;  // of the loop itself, in the last cycle
  retina::Reason fixture_reason_ = retina::Reason::none;
  std::int64_t last_moving_ = 0;    // monotonic, us: of the last cycle in a state that commands
  std::int64_t last_lit_ = 0;       // the same with the laser on
  std::int64_t registered_at_ = 0;  // the same of the last REGISTRATION
  std::int64_t adoptions_ = 0;      // in it
  retina::Reason registration_reason_ = retina::Reason::none;
  BurnOutput burn_;
  std::optional<Eigen::Vector3d> burn_goal_;  // until the hand-over from it is complete
  bool commanded_ = false;                    // in the last cycle
  int unobeyed_ = 0;                          // cycles in which commands were sent and none was obeyed
  std::optional<messaging::MicronCommand> motion_;
};

}  // namespace eyeslam::servo
