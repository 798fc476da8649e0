// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

#include "eyeslam/messaging/message_lengths.h"

namespace eyeslam::messaging {

/// Decodes bytes that nobody has checked: a log's, or a hostile sender's.
/// @return whether they are a message of this type, whole and no longer; else `message` holds anything
template <class Message>
bool decode(const std::uint8_t* bytes, std::size_t size, Message& message)
try {
  if (!hasItsLengths<Message>(bytes, size)) return false;
  const int length = static_cast<int>(size);
  return message.decode(bytes, 0, length) == length;
} catch (...) {  // generated code allocates
  return false;
}

}  // namespace eyeslam::messaging
