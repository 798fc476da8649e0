// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace eyeslam::messaging {

/// Bytes of a tag; the last field `byte tag[16]` of every message that can move the tip or fire (contracts, section 4).
constexpr std::size_t kTagBytes = 16;
using Tag = std::array<std::uint8_t, kTagBytes>;

/// The secret that all programs of one experiment share.
using Key = std::array<std::uint8_t, 32>;

/// Reads a key of 64 hexadecimal digits (`od -An -tx1 -N32 /dev/urandom > FILE && chmod 600 FILE`); white space around
/// is ignored.
/// @throws std::runtime_error  naming the file and the remedy: not readable, readable by other users, not 64 digits
Key readKey(const std::string& path);

/// Makes and checks tags: keyed BLAKE2b over the channel's name, a NUL and the encoded message before its tag. The name
/// is in it because types of equal fields share LCM's fingerprint: a goal must not pass as a fire command.
class Authenticator {
 public:
  explicit Authenticator(const Key& key);

  /// @param body  the encoded message without its last kTagBytes. Never throws, never allocates; about 1 us.
  Tag tag(std::string_view channel, const std::uint8_t* body, std::size_t size) const;

  /// Whether an encoded message (whole, the tag at its end) came from a holder of the key over this channel.
  bool verifies(std::string_view channel, const std::uint8_t* message, std::size_t size) const;

 private:
  Key key_;
};

}  // namespace eyeslam::messaging
