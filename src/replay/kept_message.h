// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/files/log_event.h"

namespace eyeslam::replay {

/// A message of a log that outlives the reading of the next one.
struct KeptMessage {
  explicit KeptMessage(const files::LogEvent& event)
      : number(event.number), utime(event.utime), channel(event.channel), bytes(event.data, event.data + event.size)
  {}

  files::LogEvent event() const { return {number, utime, channel, bytes.data(), bytes.size()}; }

  std::int64_t number, utime;
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

}  // namespace eyeslam::replay
