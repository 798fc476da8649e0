// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/refusal_watch.h"

#include <algorithm>

namespace eyeslam::servo {

using retina::Reason;

namespace {

// What a wire without faults and a sender without malice do not bring forth.
constexpr std::array kSuspicious{Reason::unauthenticated, Reason::wrong_type,   Reason::wrong_length, Reason::replayed,
                                 Reason::not_finite,      Reason::out_of_range, Reason::wrong_session};

}  // namespace

void RefusalWatch::note(Times& times, std::int64_t monotonic) noexcept
{
  times.newest[times.next] = monotonic;
  times.next = (times.next + 1) % kMost;
  times.size = std::min(times.size + 1, kMost);
}

void RefusalWatch::update(const messaging::Refusals& counts, std::int64_t monotonic) noexcept
{
  if (!started_) counts_ = counts;
  started_ = true;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto grown = std::clamp<std::int64_t>(counts[i] - counts_[i], 0, kMost);
    for (std::int64_t k = 0; k < grown; ++k) note(times_[i], monotonic);
  }
  counts_ = counts;
}

void RefusalWatch::forget() noexcept
{
  for (Times& times : times_) times.size = 0;
}

Reason RefusalWatch::tooMany(std::int64_t monotonic, std::int64_t window, std::size_t most) const noexcept
{
  for (const Reason reason : kSuspicious) {
    const Times& times = times_[messaging::refusalIndex(reason)];
    if (times.size <= most) continue;
    const std::int64_t first = times.newest[(times.next + kMost - 1 - most) % kMost];
    if (monotonic - first < window) return reason;
  }
  return Reason::none;
}

}  // namespace eyeslam::servo
