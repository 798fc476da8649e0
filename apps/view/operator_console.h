// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "view/plan_proposal.h"
#include "view/wish_commands.h"

namespace eyeslam::apps {

/// The human's end of the messages: what lines ask for goes out as OPERATOR, what the servo answers comes back as text.
/// Speaks through `say` alone; the clock is the caller's.
class OperatorConsole {
 public:
  using Say = std::function<void(const std::string& line)>;

  /// @param link       must outlive it; the caller drains it
  /// @param centre_px  of the image
  OperatorConsole(messaging::Link& link, const Eigen::Vector2d& centre_px, Say say);
  // The subscriptions hold its address.
  OperatorConsole(const OperatorConsole&) = delete;
  OperatorConsole& operator=(const OperatorConsole&) = delete;

  /// Obeys a line. @throws CommandError, files::FileError
  void obey(const std::string& line, const messaging::ReceiveTime& now);
  /// After the link was drained: tells what changed, and sends OPERATOR and the proposed plan when they are due.
  /// @throws CommandError when what a line waits for has not come in its time
  void work(const messaging::ReceiveTime& now);

  /// Whether the last line waits for something: the next one may have to wait, too.
  bool waits() const { return awaited_.has_value(); }
  /// Whether a line has asked for the end.
  bool quits() const { return quits_; }
  /// From now on: Standby, disarmed, and no line is waited for.
  void standBy(const messaging::ReceiveTime& now);

 private:
  struct Awaited {
    std::string what;
    std::function<bool()> has_come;
    std::int64_t deadline = 0;  // monotonic us
    bool must_come = true;      // or it is only a pause
  };

  void obeyOther(const CommandWords& words, const messaging::ReceiveTime& now);
  void propose(const CommandWords& words);
  void approve(const CommandWords& words);
  void await(const CommandWords& words, const messaging::ReceiveTime& now);
  std::function<bool()> condition(const std::string& what) const;
  void sayStatus() const;
  void sayHelp() const;

  void onStatus(const messaging::ServoStatus& status);
  void onRegistration(const messaging::PublishedRegistration& registration);
  void sayWhenSilent(std::int64_t monotonic);
  void endWaiting(std::int64_t monotonic);
  void send(const messaging::ReceiveTime& now);
  Sight sight() const;

  Say say_;
  Eigen::Vector2d centre_px_;
  messaging::OperatorWish wish_;
  PlanProposal proposal_;
  std::optional<Awaited> awaited_;
  bool changed_ = true;          // since the last OPERATOR
  std::int64_t changed_at_ = 0;  // us since 1970
  std::int64_t sent_at_ = 0;     // monotonic us
  std::int64_t proposed_at_ = 0;
  std::string last_state_;
  std::string last_registration_;
  bool silent_ = false;
  bool quits_ = false;

  messaging::Publisher<operator_t> wishes_;
  messaging::Publisher<burn_plan_t> plans_;
  messaging::Subscription<servo_status_t> statuses_;
  messaging::Subscription<registration_t> registrations_;
  messaging::Subscription<retina_pose_t> poses_;
  messaging::Subscription<tool_tip_t> tips_;
};

}  // namespace eyeslam::apps
