// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/sender_clock.h"

#include <algorithm>
#include <limits>

namespace eyeslam::messaging {
namespace {

// The first messages may have waited for their reader; until so many have come, falling behind them is no step.
constexpr std::int64_t kSettlingMessages = 5;
constexpr std::int64_t kSettling_us = 100'000;

constexpr std::int64_t kWindow_us = 1'000'000;
constexpr std::int64_t kWindowMessages = 8;

}  // namespace

bool SenderClock::follows(std::int64_t sent, std::int64_t received)
{
  if (stepped_) return false;
  if (messages_ == 0) start(sent, received);
  const double offset = static_cast<double>(received - sent);
  const double drift = kDrift * static_cast<double>(std::max<std::int64_t>(0, received - last_received_));
  stepped_ = sent < last_sent_ || jumpedAhead(offset, drift, received) || staysLate(offset, received);
  if (stepped_) return false;
  offset_ = std::min(offset, offset_ + drift);
  last_sent_ = sent;
  last_received_ = received;
  ++messages_;
  return true;
}

void SenderClock::start(std::int64_t sent, std::int64_t received)
{
  offset_ = static_cast<double>(received - sent);
  first_received_ = last_received_ = received;
  last_sent_ = sent;
  openWindow(received);
}

bool SenderClock::jumpedAhead(double offset, double drift, std::int64_t received) const
{
  const bool settled = messages_ >= kSettlingMessages && received - first_received_ >= kSettling_us;
  return settled && offset < offset_ - drift - kStep_us;
}

// A delay ends: of a second's messages one at least is as quick as ever.
bool SenderClock::staysLate(double offset, std::int64_t received)
{
  lowest_delay_ = std::min(lowest_delay_, offset - offset_);
  ++window_messages_;
  if (received - window_start_ < kWindow_us || window_messages_ < kWindowMessages) return false;
  const bool late = lowest_delay_ > kStep_us;
  openWindow(received);
  return late;
}

void SenderClock::openWindow(std::int64_t received)
{
  window_start_ = received;
  window_messages_ = 0;
  lowest_delay_ = std::numeric_limits<double>::max();
}

}  // namespace eyeslam::messaging
