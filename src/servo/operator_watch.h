// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/servo/servo_ears.h"
#include "eyeslam/servo/supervisor.h"

namespace eyeslam::servo {

/// What the human wants, and when he re-arms: his counter has grown within one session of his program. Its first
/// message tells where the counter stands, so that another program cannot re-arm by speaking for the first time.
///
/// A silent program's place may be taken by another: nobody else could ever re-arm. Nothing moves then, because without
/// OPERATOR the servo is in Hold, Fault or Standby.
class OperatorWatch {
 public:
  /// @param silence  us without OPERATOR, after which another program may speak
  OperatorWatch(ServoEars& ears, std::int64_t silence) : ears_(ears), silence_(silence) {}

  /// After the link was drained, in every cycle. @param monotonic  us, now
  const Wish& update(std::int64_t monotonic) noexcept;

 private:
  ServoEars& ears_;
  std::int64_t silence_;
  std::int64_t session_ = 0;
  std::int64_t rearmed_ = 0;
  Wish wish_;
};

}  // namespace eyeslam::servo
