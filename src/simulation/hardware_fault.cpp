// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/hardware_fault.h"

#include <stdexcept>

namespace eyeslam::simulation {

const std::vector<const char*>& hardwareFaultNames()
{
  static const std::vector<const char*> names = {"states_stop",    "tip_not_finite", "restart",
                                                 "clock_step",     "power_off",      "laser_silent",
                                                 "interlock_open", "camera_stops",   "camera_freezes"};
  return names;
}

HardwareFault hardwareFault(const std::string& name)
{
  std::string known;
  const auto& names = hardwareFaultNames();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (name == names[i]) return static_cast<HardwareFault>(i);
    known += (i == 0 ? "" : ", ") + std::string(names[i]);
  }
  throw std::invalid_argument("fault '" + name + "' is not known; known are " + known);
}

}  // namespace eyeslam::simulation
