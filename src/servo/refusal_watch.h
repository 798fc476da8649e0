// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "eyeslam/messaging/channel_guard.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::servo {

/// Whether one source has refused more messages for one reason than the wire explains: within any window of time, not
/// in steps of it. Late and overtaken messages happen on a busy wire and are not counted. Never allocates.
class RefusalWatch {
 public:
  static constexpr std::size_t kMost = 16;

  /// The source's counters, since its start. The first ones are its past; smaller ones than before are those of a
  /// source that started anew.
  void update(const messaging::Refusals& counts, std::int64_t monotonic) noexcept;
  /// From the present counters on.
  void forget() noexcept;
  /// The first reason with more than `most` (< kMost) refusals within `window` us; none when there is none.
  retina::Reason tooMany(std::int64_t monotonic, std::int64_t window, std::size_t most) const noexcept;

 private:
  struct Times {
    std::array<std::int64_t, kMost> newest{};  // monotonic, us, a ring
    std::size_t next = 0;
    std::size_t size = 0;
  };

  void note(Times& times, std::int64_t monotonic) noexcept;

  messaging::Refusals counts_{};
  bool started_ = false;
  std::array<Times, messaging::kRefusalReasons> times_{};
};

}  // namespace eyeslam::servo
