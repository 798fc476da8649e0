// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eyeslam/messaging/authentication.h"
#include "eyeslam/messaging/conversion.h"
#include "eyeslam/messaging/message_header.h"

namespace lcm {
class LCM;
}

namespace eyeslam::messaging {

/// Both of a program's clocks, now.
using Clocks = ReceiveTime (*)();

/// One program's connection to LCM. One thread drains it (LCM hangs when two do); publishing is free to all.
///
///   Link link("", session, readKey("micron.key"));
///   Publisher<micron_command_t> commands(link);
///   Subscription<micron_state_t> states(link);
///   while (link.wait(100)) {
///     link.drain({monotonic_now, utime_now});
///     if (const MicronState* state = states.latest()) commands.publish(next(*state), states.header().utime,
///     utime_now);
///   }
class Link {
 public:
  /// @param url      `udpm://ADDRESS:PORT?ttl=N`; `memq://` within this object; `file://PATH?mode=w` writes a log,
  ///                 `file://PATH?speed=S` reads one, S = 0 without pauses; empty: LCM_DEFAULT_URL, and without that
  ///                 LCM's own address with ttl=0, which does not leave this computer
  /// @param session  this run of the program, not 0; receivers keep to the first session they hear
  /// @param key      signs messages; without it only what stays on this computer (ttl=0, memq, file) is served
  /// @throws std::runtime_error  one line with the URL and the remedy
  Link(const std::string& url, std::int64_t session, const std::optional<Key>& key);
  ~Link();

  std::int64_t session() const { return session_; }
  /// Null without a key.
  const Authenticator* authenticator() const { return authenticator_ ? &*authenticator_ : nullptr; }
  /// The URL in use, with the default filled in.
  const std::string& url() const { return url_; }
  /// For subscriptions: `memq://` connects only within one object.
  lcm::LCM& lcm() { return *lcm_; }

  /// Sends an encoded message. @return whether LCM took it (nobody knows whether it arrives)
  bool send(const std::string& channel, const std::uint8_t* bytes, std::size_t size);

  /// Waits for a message without handling it. @return whether there may be one; false after the time, or on a signal
  bool wait(int timeout_ms);

  /// Hands every message that has come to its subscription; so the subscriptions hold the latest ones after it. 5 to 7
  /// us a message.
  /// @param now   by the caller's clocks; messages count as received now
  /// @param most  bounds the time under a flood; what is left waits in a queue of 10,000 a channel
  /// @return messages handled; fewer than `most` when there are no more
  std::size_t drain(const ReceiveTime& now, std::size_t most = 10'000);

  /// The same by clocks that go on meanwhile: a message that comes while its reader is kept from the processor was not
  /// received before it was sent, which would look like a step of its sender's clock.
  std::size_t drain(Clocks clocks, std::size_t most = 10'000);

  /// Lock step, for reading logs: hands over one message, received at the very time at which it was sent.
  /// @return false at the end of the log (and at damage, which LCM's reader does not tell apart)
  bool step();

  /// When the message that is being handled was received.
  ReceiveTime receivedAt(const MessageHeader& header) const
  {
    if (clocks_ != nullptr) return clocks_();
    return now_.value_or(ReceiveTime{header.utime_sent, header.utime_sent});
  }

 private:
  std::size_t handle(std::size_t most);

  std::string url_;
  std::int64_t session_;
  std::optional<Authenticator> authenticator_;
  std::unique_ptr<lcm::LCM> lcm_;
  std::unique_ptr<std::mutex> file_;  // of file:// alone: LCM guards its sockets itself, but not its files
  std::optional<ReceiveTime> now_;    // none in lock step
  Clocks clocks_ = nullptr;           // none where the caller says what time it is
};

/// Publishes one type on one channel: fills what every message has (contracts, section 4), encodes and signs it.
/// One thread. After the first message of a size it allocates nothing.
template <class Message>
class Publisher {
 public:
  /// @param session  0: the link's; another one is for a device that has been started anew
  explicit Publisher(Link& link, std::string channel = channelOf<Message>(), std::int64_t session = 0)
      : link_(link), channel_(std::move(channel)), session_(session == 0 ? link.session() : session)
  {}

  /// @param message     all fields but utime_sent, seq, session and tag are the caller's; these are filled
  /// @param utime_sent  now, us since 1970
  /// @return whether LCM took it; a refused message used up its number, so that receivers see the gap
  bool publish(Message& message, std::int64_t utime_sent)
  {
    message.utime_sent = utime_sent;
    message.seq = next_seq_++;
    message.session = session_;
    bytes_.resize(static_cast<std::size_t>(message.getEncodedSize()));
    if (!encode(message)) return false;
    if constexpr (HasTag<Message>::value) sign(message);
    return link_.send(channel_, bytes_.data(), bytes_.size());
  }

  /// Publishes a value (conversion.h).
  /// @param utime  us since 1970: of what it describes
  /// @return whether it was sent; not where a number in it is not finite or out of its range
  template <class Value>
  bool publish(const Value& value, std::int64_t utime, std::int64_t utime_sent)
  {
    message_.utime = utime;
    return write(value, message_) == retina::Reason::none && publish(message_, utime_sent);
  }

  /// Messages published so far, refused ones included.
  std::int64_t count() const { return next_seq_; }

 private:
  bool encode(const Message& message)
  {
    const int size = static_cast<int>(bytes_.size());
    return message.encode(bytes_.data(), 0, size) == size;
  }

  // The tag is the last field, and bytes are encoded as they are.
  void sign(Message& message)
  {
    const std::size_t body = bytes_.size() - kTagBytes;
    const Authenticator* authenticator = link_.authenticator();
    const Tag tag = authenticator ? authenticator->tag(channel_, bytes_.data(), body) : Tag{};
    for (std::size_t i = 0; i < kTagBytes; ++i) message.tag[i] = bytes_[body + i] = tag[i];
  }

  Link& link_;
  std::string channel_;
  std::int64_t session_;
  std::int64_t next_seq_ = 0;
  Message message_{};  // of the last value
  std::vector<std::uint8_t> bytes_;
};

}  // namespace eyeslam::messaging
