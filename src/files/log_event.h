// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace eyeslam::files {

/// One message of an LCM log. In a file: 0xEDA1DA01, number (8 bytes), time (8), lengths of channel and data (4 each),
/// all big-endian, then the channel without a NUL, then the data.
struct LogEvent {
  std::int64_t number = 0;  ///< from 0, rises by one
  std::int64_t utime = 0;   ///< us since 1970, when the logger received it
  std::string_view channel;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

constexpr std::uint32_t kLogMagic = 0xEDA1DA01;
constexpr std::size_t kLogHeaderBytes = 28;
constexpr std::size_t kLongestChannel = 63;  ///< LCM_MAX_CHANNEL_NAME_LENGTH

}  // namespace eyeslam::files
