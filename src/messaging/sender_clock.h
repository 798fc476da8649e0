// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace eyeslam::messaging {

/// A sender's clock in terms of the receiver's monotonic one, learnt from the messages alone: the quickest of them was
/// hardly delayed. A delay that all messages share from the first one on cannot be seen this way.
///
///   if (!clock.follows(message.utime_sent, now)) return Reason::clock_stepped;
///   const std::int64_t age = now - clock.toReceiver(message.utime);
class SenderClock {
 public:
  /// A smaller step only makes messages look younger or older by as much; more is more than a busy computer's jitter.
  static constexpr double kStep_us = 20e3;
  /// Fastest drift of two clocks that are not stepped: adjtime slews by 500 ppm.
  static constexpr double kDrift = 500e-6;

  /// Takes the next message of the sender, in its order.
  /// @param sent      us since 1970, by the sender
  /// @param received  us, by the receiver's monotonic clock
  /// @return whether the sender's clock went on evenly; false for ever after it did not, until forget(). A step back by
  ///         less than the time between two messages is told from a delay only after a second.
  bool follows(std::int64_t sent, std::int64_t received);

  /// When the sender's clock showed `utime`, by the receiver's clock; never later than a message was received.
  std::int64_t toReceiver(std::int64_t utime) const { return utime + static_cast<std::int64_t>(offset_); }

  /// Learns anew from the next message; until then the old relation goes on.
  void forget()
  {
    const double offset = offset_;
    *this = SenderClock();
    offset_ = offset;
  }

 private:
  void start(std::int64_t sent, std::int64_t received);
  bool jumpedAhead(double offset, double drift, std::int64_t received) const;
  bool staysLate(double offset, std::int64_t received);
  void openWindow(std::int64_t received);

  double offset_ = 0.0;  // receiver's time - sender's time, us, lowest so far
  std::int64_t messages_ = 0;
  std::int64_t first_received_ = 0;
  std::int64_t last_received_ = 0;
  std::int64_t last_sent_ = 0;
  std::int64_t window_start_ = 0;
  std::int64_t window_messages_ = 0;
  double lowest_delay_ = 0.0;  // in the window, us
  bool stepped_ = false;
};

}  // namespace eyeslam::messaging
