// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "eyeslam/messaging/message_header.h"
#include "eyeslam/messaging/sender_clock.h"
#include "eyeslam/messaging/sequence_window.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::messaging {

/// Messages refused, by reason: numbers 60 to 71 of retina::Reason, as `..._refused` in the messages.
constexpr std::size_t kRefusalReasons = 12;
constexpr std::size_t refusalIndex(retina::Reason reason)
{
  const int index = static_cast<int>(reason) - static_cast<int>(retina::Reason::unauthenticated);
  return index >= 0 && index < static_cast<int>(kRefusalReasons) ? static_cast<std::size_t>(index)
                                                                 : kRefusalReasons - 1;
}
using Refusals = std::array<std::int64_t, kRefusalReasons>;

/// Decides which messages of one channel are heard: from one sender, each once and in order, in time, by a clock that
/// does not step. No clock, no LCM. Never throws, never allocates.
class ChannelGuard {
 public:
  /// Two clocks that a network keeps together differ by less; an experiment of the past by more.
  static constexpr std::int64_t kFirstContact_us = 5'000'000;

  /// @param expiry  s after utime_sent; none where the message is no command
  /// @return none, or why not: out_of_range, wrong_session, clock_differs, replayed, out_of_order, clock_stepped,
  ///         expired
  retina::Reason admit(const MessageHeader& header, const ReceiveTime& now, std::optional<double> expiry);

  /// For channels without a tag, on which several speak and nothing moves or fires: only a possible header is asked
  /// for, and the message counts as not delayed. @return none or out_of_range
  retina::Reason admitAnyone(const MessageHeader& header, const ReceiveTime& now);

  /// A human re-armed: whoever speaks next is heard from then on, and a stepped clock is learnt anew. A session that
  /// was replaced is never heard again.
  void acceptNewSession();

  /// Why nothing is heard until a human re-arms: clock_stepped, or none.
  retina::Reason fault() const { return fault_; }

  /// The session that is listened to, the last one heard where anyone is; 0 before the first message.
  std::int64_t session() const { return session_; }
  std::int64_t lost() const { return lost_ + order_.lost(); }
  /// When the sender's clock showed `utime`, by the receiver's monotonic one; us. Holds for the session listened to.
  std::int64_t toReceiver(std::int64_t utime) const { return clock_.toReceiver(utime); }

 private:
  bool mayHear(std::int64_t session) const;
  void listenTo(std::int64_t session);

  std::int64_t session_ = 0;
  bool open_ = true;                     // to another session
  std::array<std::int64_t, 16> past_{};  // sessions replaced
  std::size_t replaced_ = 0;
  SequenceWindow order_;
  std::int64_t lost_ = 0;  // in the sessions before
  SenderClock clock_;
  retina::Reason fault_ = retina::Reason::none;
};

}  // namespace eyeslam::messaging
