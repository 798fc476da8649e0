// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <ctime>
#include <string>

#include "eyeslam/messaging/message_header.h"

namespace eyeslam::support {

inline std::int64_t clockOf(clockid_t id)
{
  timespec now{};
  clock_gettime(id, &now);
  return now.tv_sec * std::int64_t{1'000'000} + now.tv_nsec / 1000;
}

/// Now, by both clocks.
inline messaging::ReceiveTime clocks() { return {clockOf(CLOCK_MONOTONIC), clockOf(CLOCK_REALTIME)}; }

inline void sleepUntil(std::int64_t monotonic_us)
{
  const timespec until{monotonic_us / 1'000'000, monotonic_us % 1'000'000 * 1000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

/// A port that no other test of this computer is likely to use; messages stay on it.
inline std::string freeUrl()
{
  static int offset = 0;
  return "udpm://239.255.76.67:" + std::to_string(20'000 + (getpid() * 7 + offset++) % 40'000) + "?ttl=0";
}

}  // namespace eyeslam::support
