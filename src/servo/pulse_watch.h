// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/servo/unknown.h"

namespace eyeslam::servo {

/// What became of a pulse.
struct PulseFate {
  std::size_t index = 0;   ///< of its target in the plan
  bool begun = false;      ///< anything was emitted
  double emitted_s = 0.0;  ///< as the laser said
  double asked_s = 0.0;
  retina::Reason reason = retina::Reason::none;  ///< why it ended early, or did not begin
};

/// What the laser says in a cycle.
struct LaserWord {
  const messaging::LaserState* state = nullptr;  ///< null before the first
  double age_s = kUnknown;                       ///< since it was received
};

/// One pulse from the first command to the laser's word about its end. The command is held while it is meant; once it
/// is not, it never comes back. Nothing is assumed of a pulse of which the laser has not told: there is no other until
/// then. Never throws, never allocates.
class PulseWatch {
 public:
  bool isIdle() const noexcept { return phase_ == Phase::idle; }
  bool isFiring() const noexcept { return phase_ == Phase::firing; }
  std::size_t index() const noexcept { return index_; }

  /// @param pulse  target, duration, power; action, number and expiry are filled in here
  void begin(std::size_t index, const messaging::LaserCommand& pulse, const LaserWord& laser,
             std::int64_t now) noexcept;
  /// Each cycle. @param why  none, or why the pulse must not go on
  /// @return its fate, once, when it is known
  std::optional<PulseFate> follow(const LaserWord& laser, retina::Reason why, std::int64_t now) noexcept;
  /// What to send while it fires.
  const messaging::LaserCommand& command() const noexcept { return command_; }

 private:
  enum class Phase { idle, firing, ending };

  PulseFate endedWith(bool begun, double emitted_s, retina::Reason otherwise) const noexcept;

  Phase phase_ = Phase::idle;
  std::size_t index_ = 0;
  std::int64_t begun_ = 0, last_fire_ = 0;  // us
  std::int64_t number_ = 0;
  retina::Reason stopped_by_ = retina::Reason::none;
  messaging::LaserCommand command_;
};

}  // namespace eyeslam::servo
