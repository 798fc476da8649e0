// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "eyeslam/files/log_event.h"
#include "eyeslam/messaging/event_tap.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/trials/lock_step_servo.h"

namespace eyeslam::replay {

/// A servo behind a link of its own, which hears a log instead of the world. It goes on from one cycle to the next in
/// the order of `Trial`: what came is heard, the servo decides, what it says is told.
class RecomputedServo {
 public:
  /// Told of each message that it sends, within `cycle`; numbered from 0.
  using Each = std::function<void(const files::LogEvent&)>;

  /// @param session  that it had, so that it knows itself
  RecomputedServo(const trials::TrialSetting& setting, std::int64_t session, Each each);
  RecomputedServo(const servo::ServoConfiguration& configuration, std::int64_t session, Each each);

  std::int64_t session() const { return link_.session(); }
  /// Whether a servo listens to the channel; the rest is nothing to it.
  static bool hears(std::string_view channel);
  /// Whether the message is one that this servo had sent.
  bool hasSaid(const files::LogEvent& event) const;

  /// For the next cycle. Bytes as they are: what it refused then it refuses again.
  void hear(const files::LogEvent& event);
  /// @param utime  us since 1970
  void cycle(std::int64_t utime);
  bool resume(const messaging::PublishedRegistration& known, std::int64_t utime) { return servo_.resume(known, utime); }

 private:
  void tell(const messaging::TappedEvent& event);

  messaging::Link link_;
  messaging::EventTap tap_;
  trials::LockStepServo servo_;
  Each each_;
  std::string channel_;
  bool speaks_ = false;
  std::int64_t said_ = 0;
};

}  // namespace eyeslam::replay
