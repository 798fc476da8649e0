// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cctype>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

namespace eyeslam::messaging {

/// What every message begins with (contracts, section 4).
struct MessageHeader {
  std::int64_t utime = 0;       ///< us since 1970: of what the message describes
  std::int64_t utime_sent = 0;  ///< us since 1970, by the sender's clock
  std::int64_t seq = 0;         ///< of this sender on this channel, from 0
  std::int64_t session = 0;     ///< the sender's run, not 0
};

/// When a message was taken from the link, read from the receiver's clocks by the program, for libraries read none.
struct ReceiveTime {
  std::int64_t monotonic = 0;  ///< us, never steps: ages and expiries are judged by it
  std::int64_t utime = 0;      ///< us since 1970: compared with the sender's once, when a session is first heard
};

template <class Message, class = void>
struct HasTag : std::false_type {};
template <class Message>
struct HasTag<Message, std::void_t<decltype(Message::tag)>> : std::true_type {};

template <class Message, class = void>
struct HasExpiry : std::false_type {};
template <class Message>
struct HasExpiry<Message, std::void_t<decltype(Message::expiry)>> : std::true_type {};

/// Whether all messages of the type have the same length: no string, no array with a count.
template <class Message>
constexpr bool kFixedSize = std::is_trivially_copyable_v<Message>;

template <class Message>
MessageHeader headerOf(const Message& message)
{
  return {message.utime, message.utime_sent, message.seq, message.session};
}

/// s after utime_sent; none where the type is no command.
template <class Message>
std::optional<double> expiryOf(const Message& message)
{
  if constexpr (HasExpiry<Message>::value) return message.expiry;
  return std::nullopt;
}

/// The channel of a type: retina_pose_t travels on RETINA_POSE.
template <class Message>
std::string channelOf()
{
  std::string name = Message::getTypeName();
  name.resize(name.size() - 2);
  for (char& letter : name) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return name;
}

}  // namespace eyeslam::messaging
