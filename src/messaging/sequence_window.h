// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/retina/reason.h"

namespace eyeslam::messaging {

/// Lets each number of a sender pass once, and only upwards. Remembers which of the last 64 numbers came, so that a
/// message that was overtaken is told from one that comes again.
class SequenceWindow {
 public:
  /// @return none, out_of_order or replayed
  retina::Reason admit(std::int64_t seq)
  {
    if (seq < 0) return retina::Reason::replayed;  // numbers begin at 0
    if (seq > highest_) return advance(seq);
    const std::int64_t behind = highest_ - seq;
    if (behind >= kWidth || (seen_ >> behind & 1U) != 0) return retina::Reason::replayed;
    seen_ |= std::uint64_t{1} << behind;
    return retina::Reason::out_of_order;
  }

  /// Numbers left out since the first message.
  std::int64_t lost() const { return lost_; }

 private:
  static constexpr std::int64_t kWidth = 64;

  retina::Reason advance(std::int64_t seq)
  {
    if (highest_ < 0) {
      seen_ = 1U;
    } else {
      const std::int64_t ahead = seq - highest_;
      lost_ += ahead - 1;
      seen_ = ahead < kWidth ? seen_ << ahead | 1U : 1U;
    }
    highest_ = seq;
    return retina::Reason::none;
  }

  std::int64_t highest_ = -1;
  std::uint64_t seen_ = 0;  // bit i: highest_ - i came
  std::int64_t lost_ = 0;
};

}  // namespace eyeslam::messaging
