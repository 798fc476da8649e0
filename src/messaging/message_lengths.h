// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

#include "eyeslam/messaging/byte_walk.h"
#include "eyeslam/messaging/conversion.h"
#include "eyeslam/messaging/message_header.h"

namespace eyeslam::messaging {

/// Whether an encoded message is as long as its type and its own counts say, so that decoding it is safe (ByteWalk).
/// @param size  of it with its 8-byte fingerprint, >= 8
template <class Message>
bool hasItsLengths(const std::uint8_t* bytes, std::size_t size)
{
  if constexpr (kFixedSize<Message>) {
    static const auto kSize = static_cast<std::size_t>(Message().getEncodedSize());
    return size == kSize;
  } else {
    constexpr std::size_t kFingerprint = sizeof(std::int64_t);
    if (size < kFingerprint) return false;
    return Conversion<Message>::hasItsLengths(ByteWalk(bytes + kFingerprint, size - kFingerprint));
  }
}

}  // namespace eyeslam::messaging
