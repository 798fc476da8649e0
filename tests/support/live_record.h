// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/messaging/subscription.h"

namespace eyeslam::support {

template <class Message>
struct HeardMessage {
  typename messaging::Subscription<Message>::Value value;
  messaging::MessageHeader header;
  std::int64_t came = 0;  ///< us since 1970, by the listener's clock
};

/// Hears one channel and keeps everything.
template <class Message>
class ChannelRecord {
 public:
  using Heard = HeardMessage<Message>;

  explicit ChannelRecord(messaging::Link& link)
      : subscription_(link, [this, &link](const auto& value, const auto& header) {
          all_.push_back({value, header, link.receivedAt(header).utime});
        })
  {}

  const std::vector<Heard>& all() const { return all_; }
  bool empty() const { return all_.empty(); }
  const Heard& last() const { return all_.back(); }
  /// Those sent at that time or later, even where the sender's clock has stepped ahead.
  std::vector<Heard> since(std::int64_t utime) const
  {
    std::vector<Heard> part;
    std::copy_if(all_.begin(), all_.end(), std::back_inserter(part),
                 [utime](const Heard& heard) { return std::min(heard.header.utime_sent, heard.came) >= utime; });
    return part;
  }
  void acceptNewSession() { subscription_.acceptNewSession(); }

 private:
  std::vector<Heard> all_;
  messaging::Subscription<Message> subscription_;  // last: it writes into the others
};

/// Somebody who only listens, on a link of his own, and remembers.
class LiveRecord {
 public:
  LiveRecord(const std::string& url, std::int64_t session, const messaging::Key& key) : link_(url, session, key) {}

  void drain(const messaging::ReceiveTime& now) { link_.drain(now); }
  void acceptNewSessions()
  {
    states.acceptNewSession();
    lasers.acceptNewSession();
    motions.acceptNewSession();
    lights.acceptNewSession();
  }

 private:
  messaging::Link link_;

 public:
  ChannelRecord<servo_status_t> statuses{link_};
  ChannelRecord<micron_state_t> states{link_};
  ChannelRecord<laser_state_t> lasers{link_};
  ChannelRecord<micron_command_t> motions{link_};
  ChannelRecord<laser_command_t> lights{link_};
  ChannelRecord<retina_pose_t> poses{link_};
};

}  // namespace eyeslam::support
