// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/retina/options.h"
#include "eyeslam/simulation/heard_command.h"

namespace eyeslam::simulation {

struct LaserDeviceOptions {
  double expiry_ms = 5.0;
  double longest_pulse_ms = 200.0;
  double highest_power_w = 0.75;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("expiry_ms", self.expiry_ms, Range{1, 1000}, "ms",
                  "after sending, a command is not obeyed for longer, whatever it says; source: contracts, 4");
    visitor.field("longest_pulse_ms", self.longest_pulse_ms, Range{1, 1000}, "ms",
                  "a longer pulse is refused; source: facts, D1, 100-200 ms");
    visitor.field("highest_power_w", self.highest_power_w, Range{0.01, 10}, "W",
                  "a stronger pulse is refused; source: facts, D1, 250-750 mW");
  }
};

/// What humans have done to a laser.
struct LaserSwitches {
  bool foot_switch = false;
  bool armed = true;
  bool interlock_closed = true;
};

/// A photocoagulator with interlocks of its own. It emits only while a FIRE command is in force that it has obeyed, the
/// foot switch is pressed, it is armed and the remote interlock is closed; any of these gone ends the pulse at once. A
/// number begins one pulse at most: one that was refused or cut short is spent, and a later try needs a new number.
/// The aiming beam is on while a command to aim or to fire is in force. Never allocates. Source: facts, D2;
/// contracts, 4.
class LaserDevice {
 public:
  explicit LaserDevice(const LaserDeviceOptions& options, double period_s = 1e-3);

  /// One period later. @return what it says of itself then
  const messaging::LaserState& step(const LaserSwitches& switches, const HeardCommand<messaging::LaserCommand>& heard);
  const messaging::LaserState& state() const { return state_; }
  /// Of the last pulse begun, as commanded; s, W.
  double duration() const { return duration_; }
  double power() const { return power_; }

 private:
  retina::Reason whyNoEmission() const;
  retina::Reason whyNoPulse(const messaging::LaserCommand& command) const;
  void emit(const messaging::LaserCommand* command);
  void consider(const messaging::LaserCommand& command, std::int64_t session);
  void end(retina::Reason why);

  double longest_command_, longest_pulse_, highest_power_, period_s_;
  double duration_ = 0.0, power_ = 0.0;
  std::int64_t spent_ = 0;    // numbers up to this one
  std::int64_t session_ = 0;  // of whose pulses
  messaging::LaserState state_;
};

}  // namespace eyeslam::simulation
