// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

namespace eyeslam::messaging {

/// Walks over an encoded message and checks what its counts claim against the bytes that are there: the generated
/// decoders allocate before they check (a count of 2^28 in 76 bytes crashes them). Never reads beyond the message.
///
///   std::int64_t cells = 0;
///   return walk.fields(88).count(cells, 1, 400).fields(3 * cells + 16).isAtEnd();
class ByteWalk {
 public:
  /// @param bytes  a message behind its 8-byte fingerprint
  ByteWalk(const std::uint8_t* bytes, std::size_t size) : next_(bytes), left_(static_cast<std::int64_t>(size)) {}

  /// Steps over fields of fixed size.
  ByteWalk& fields(std::int64_t bytes)
  {
    good_ = good_ && bytes >= 0 && bytes <= left_;
    if (!good_) return *this;
    next_ += bytes;
    left_ -= bytes;
    return *this;
  }

  /// Reads an int32_t that must lie in [lowest, highest].
  ByteWalk& count(std::int64_t& value, std::int64_t lowest, std::int64_t highest)
  {
    value = 0;
    const std::uint8_t* at = next_;
    if (!fields(4).good_) return *this;
    const std::uint32_t bits =
        std::uint32_t{at[0]} << 24U | std::uint32_t{at[1]} << 16U | std::uint32_t{at[2]} << 8U | at[3];
    const std::int64_t read = static_cast<std::int32_t>(bits);
    good_ = read >= lowest && read <= highest;
    if (good_) value = read;
    return *this;
  }

  /// Steps over a string: its length with the NUL, its characters, the NUL.
  ByteWalk& text(std::int64_t longest)
  {
    std::int64_t length = 0;
    count(length, 1, longest + 1).fields(length);
    good_ = good_ && next_[-1] == 0;
    return *this;
  }

  bool isAtEnd() const { return good_ && left_ == 0; }

 private:
  const std::uint8_t* next_;
  std::int64_t left_;
  bool good_ = true;
};

}  // namespace eyeslam::messaging
