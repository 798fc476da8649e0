// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <string>
#include <string_view>

#include "eyeslam/messaging/link.h"

namespace lcm {
class Subscription;
struct ReceiveBuffer;
}  // namespace lcm

namespace eyeslam::messaging {

/// A message as it passes, for as long as the call lasts.
struct TappedEvent {
  std::int64_t number = 0;  ///< from 0
  std::int64_t utime = 0;   ///< us since 1970, as the tap was told
  std::string_view channel;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Hears every message of a link as bytes, in the order in which they were sent: what a logger would write.
class EventTap {
 public:
  using Each = std::function<void(const TappedEvent&)>;

  /// @param link  must outlive it; whoever owns it drains it
  /// @param each  what it throws cannot pass LCM: it is kept, and thrown by the next `setTime`
  EventTap(Link& link, Each each);
  ~EventTap();
  EventTap(const EventTap&) = delete;
  EventTap& operator=(const EventTap&) = delete;

  /// Of the events to come, us since 1970; before the link is drained.
  void setTime(std::int64_t utime);

 private:
  void onMessage(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  Link& link_;
  Each each_;
  lcm::Subscription* subscription_;
  std::int64_t utime_ = 0, events_ = 0;
  std::exception_ptr failure_;
};

}  // namespace eyeslam::messaging
