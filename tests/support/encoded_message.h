// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/messaging/authentication.h"
#include "eyeslam/messaging/message_header.h"

namespace eyeslam::support {

using Bytes = std::vector<std::uint8_t>;

/// A message as any sender would put it on the wire: nothing is filled in, the tag is made with `key` for `channel`.
template <class Message>
Bytes encodedMessage(const Message& message, const std::optional<messaging::Key>& key = {},
                     const std::string& channel = messaging::channelOf<Message>())
{
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  if (key && messaging::HasTag<Message>::value) {
    const std::size_t body = bytes.size() - messaging::kTagBytes;
    const messaging::Tag tag = messaging::Authenticator(*key).tag(channel, bytes.data(), body);
    std::copy(tag.begin(), tag.end(), bytes.begin() + static_cast<std::ptrdiff_t>(body));
  }
  return bytes;
}

template <class Message>
bool decodeMessage(const Bytes& bytes, Message& message)
{
  return message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) == static_cast<int>(bytes.size());
}

}  // namespace eyeslam::support
