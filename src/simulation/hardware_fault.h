// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace eyeslam::simulation {

/// What may go wrong with the hardware, on request.
enum class HardwareFault {
  states_stop,     ///< no MICRON_STATE is sent any more
  tip_not_finite,  ///< the measured tip is NaN
  restart,         ///< the manipulator's controller starts anew: another session; happens once
  clock_step,      ///< the devices' clock goes on a second later
  power_off,       ///< of the manipulator's motors
  laser_silent,    ///< no LASER_STATE is sent any more
  interlock_open,  ///< the laser's remote interlock
  camera_stops,    ///< no frames any more
  camera_freezes   ///< the same picture again and again
};
constexpr std::size_t kHardwareFaults = 9;

/// Their words, in the order of the enumerators.
const std::vector<const char*>& hardwareFaultNames();
/// @throws std::invalid_argument naming the word and those known
HardwareFault hardwareFault(const std::string& name);

}  // namespace eyeslam::simulation
