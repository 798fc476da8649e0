// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <string>

#include "eyeslam/files/log_event.h"
#include "eyeslam/messaging/link.h"

namespace lcm {
class Subscription;
struct ReceiveBuffer;
}  // namespace lcm

namespace eyeslam::trials {

/// Hears every message of a link as bytes, in the order in which they were sent: what a logger would write.
class EventTap {
 public:
  using Each = std::function<void(const files::LogEvent&)>;

  /// @param link  must outlive it; whoever owns it drains it
  /// @param each  must not throw through LCM: what it throws is kept, and thrown again by `setTime`
  EventTap(messaging::Link& link, Each each);
  ~EventTap();
  EventTap(const EventTap&) = delete;
  EventTap& operator=(const EventTap&) = delete;

  /// Of the events to come, us since 1970; before the link is drained.
  void setTime(std::int64_t utime);

 private:
  void onMessage(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  messaging::Link& link_;
  Each each_;
  lcm::Subscription* subscription_;
  std::int64_t utime_ = 0, events_ = 0;
  std::exception_ptr failure_;
};

}  // namespace eyeslam::trials
