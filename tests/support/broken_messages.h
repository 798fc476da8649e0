// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <random>
#include <string>

namespace eyeslam::support {

/// What a broken log does to a message: bits of its bytes are others, whole fields are extreme, or its end is missing.
/// The fingerprint stays, so that it still passes for one of ours.
inline void breakMessage(std::string& bytes, std::mt19937& random)
{
  constexpr std::size_t kFingerprint = 8;
  if (bytes.size() <= kFingerprint) return;
  const std::size_t at = kFingerprint + random() % (bytes.size() - kFingerprint);
  switch (random() % 4) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
      break;
    case 1:
      bytes[at] = static_cast<char>(random());
      break;
    case 2:
      for (std::size_t i = at; i < bytes.size() && i < at + 8; ++i) bytes[i] = random() % 2 == 0 ? '\x7F' : '\xFF';
      break;
    default:
      bytes.resize(at);
      break;
  }
}

}  // namespace eyeslam::support
