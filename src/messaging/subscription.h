// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "eyeslam/messaging/channel_guard.h"
#include "eyeslam/messaging/conversion.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/message_header.h"
#include "eyeslam/messaging/message_lengths.h"

namespace lcm {
struct ReceiveBuffer;
class Subscription;
}  // namespace lcm

namespace eyeslam::messaging {

/// What a subscription does whatever its type: takes raw bytes from LCM, refuses what is not to be decoded, lets no
/// exception out, counts.
class ChannelReceiver {
 public:
  virtual ~ChannelReceiver();
  ChannelReceiver(const ChannelReceiver&) = delete;
  ChannelReceiver& operator=(const ChannelReceiver&) = delete;

  const std::string& channel() const { return channel_; }

  /// us since the last message was accepted; the largest number before the first.
  std::int64_t silence(std::int64_t monotonic) const { return accepted_ == 0 ? kNever : monotonic - last_received_; }
  /// us since what the last message describes (for vision, mid-exposure), by the receiver's monotonic clock; the
  /// largest number before the first.
  std::int64_t age(std::int64_t monotonic) const
  {
    return accepted_ == 0 ? kNever : monotonic - guard_.toReceiver(header_.utime);
  }
  /// Whether the last message is a command and has not expired.
  bool isInForce(std::int64_t monotonic) const;

  std::int64_t received() const { return received_; }
  std::int64_t accepted() const { return accepted_; }
  /// Numbers that the sender left out or that were overtaken.
  std::int64_t lost() const { return guard_.lost(); }
  const Refusals& refused() const { return refused_; }
  std::int64_t refused(retina::Reason reason) const { return refused_[refusalIndex(reason)]; }

  /// Why nothing is heard until a human re-arms; none when all is well.
  retina::Reason fault() const { return guard_.fault(); }
  /// The session listened to, the first one heard (the last one on a channel without a tag); 0 before.
  std::int64_t session() const { return guard_.session(); }
  /// Only a human act calls this: the next session heard may take the place of the present one.
  void acceptNewSession() { guard_.acceptNewSession(); }

  /// The last accepted message's.
  const MessageHeader& header() const { return header_; }
  /// When the sender's clock showed `utime`, by the receiver's monotonic clock, us.
  std::int64_t toReceiver(std::int64_t utime) const { return guard_.toReceiver(utime); }

 protected:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  ChannelReceiver(Link& link, std::string channel, std::int64_t fingerprint, bool has_tag);

  /// Decodes bytes that bear the type's fingerprint and a good tag.
  virtual retina::Reason take(const std::uint8_t* bytes, std::size_t size) = 0;
  /// Whether the message is heard; then it is the last accepted one.
  retina::Reason admit(const MessageHeader& header, std::optional<double> expiry);

 private:
  void onMessage(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  retina::Reason check(const std::uint8_t* bytes, std::size_t size) const;

  Link& link_;
  std::string channel_;
  std::int64_t fingerprint_;
  bool has_tag_;
  lcm::Subscription* subscription_ = nullptr;
  ChannelGuard guard_;
  MessageHeader header_;
  std::optional<double> expiry_;
  std::int64_t last_received_ = 0;
  std::int64_t received_ = 0;
  std::int64_t accepted_ = 0;
  Refusals refused_{};
};

/// Hears one type on one channel, keeps the latest value, and says how old it is. Nothing is believed that is not of
/// the type, the right length, signed (where the link has a key), finite, within its range, from the sender first
/// heard, in order and in time; all else is counted by reason. Messages of fixed size are taken without allocating.
///
///   Subscription<micron_state_t> states(link);
///   link.drain({monotonic_now, utime_now});
///   if (states.silence(monotonic_now) < 50'000) use(states.value());
///
/// The thread that drains the link is the only one that may use it; the link must outlive it. The first subscription of
/// a link starts LCM's receiving thread, with the scheduling class that its caller has then: set that before.
template <class Message>
class Subscription : public ChannelReceiver {
 public:
  using Value = typename Conversion<Message>::Value;
  /// Called for each accepted message while the link is drained, for channels of which every message counts.
  using Each = std::function<void(const Value&, const MessageHeader&)>;

  explicit Subscription(Link& link, Each each = {}, std::string channel = channelOf<Message>())
      : ChannelReceiver(link, std::move(channel), Message::getHash(), HasTag<Message>::value), each_(std::move(each))
  {}

  /// The last accepted one; none before the first.
  const Value* latest() const { return accepted() == 0 ? nullptr : &value_; }
  /// The same for a command that has not expired.
  const Value* inForce(std::int64_t monotonic) const { return isInForce(monotonic) ? &value_ : nullptr; }

 private:
  retina::Reason take(const std::uint8_t* bytes, std::size_t size) override
  {
    using retina::Reason;
    if (!hasItsLengths<Message>(bytes, size)) return Reason::wrong_length;
    const int length = static_cast<int>(size);
    if (message_.decode(bytes, 0, length) != length) return Reason::wrong_length;
    if (const Reason why = read(message_, candidate_); why != Reason::none) return why;
    if (const Reason why = admit(headerOf(message_), expiryOf(message_)); why != Reason::none) return why;
    std::swap(value_, candidate_);
    if (each_) each_(value_, header());
    return Reason::none;
  }

  Each each_;
  Message message_{};
  Value candidate_{};
  Value value_{};
};

}  // namespace eyeslam::messaging
