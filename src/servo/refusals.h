// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "eyeslam/retina/reason.h"

namespace eyeslam::servo {

/// How often the loop refused something, and why last. Never allocates.
class Refusals {
 public:
  void count(retina::Reason reason) noexcept
  {
    if (reason == retina::Reason::none) return;
    last_ = reason;
    const auto number = static_cast<std::size_t>(reason);
    if (number < counts_.size()) ++counts_[number];
  }
  std::int64_t of(retina::Reason reason) const noexcept
  {
    const auto number = static_cast<std::size_t>(reason);
    return number < counts_.size() ? counts_[number] : 0;
  }
  std::int64_t total() const noexcept
  {
    std::int64_t sum = 0;
    for (const std::int64_t count : counts_) sum += count;
    return sum;
  }
  retina::Reason last() const noexcept { return last_; }

 private:
  std::array<std::int64_t, 256> counts_{};  // by the reason's number
  retina::Reason last_ = retina::Reason::none;
};

}  // namespace eyeslam::servo
