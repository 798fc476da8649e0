// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/retina_motion_options.h"

#include <stdexcept>

namespace eyeslam::simulation {

namespace {

// A slide on a table: nothing breathes, and no port ties it to the instrument.
RetinaMotionOptions paperRetinaMotion()
{
  RetinaMotionOptions options;
  options.hand_share = 0.0;
  options.port_gain = options.port_tremor = options.port_travel = 0.0;
  options.breath_low_um = options.breath_high_um = options.breath_axial_um = 0.0;
  options.pulse_low_um = options.pulse_high_um = options.pulse_axial_um = 0.0;
  options.axial_noise_um = 0.0;
  return options;
}

RetinaMotionOptions jerkyRetinaMotion()
{
  RetinaMotionOptions options;
  options.jerks_per_s = 0.4;
  return options;
}

RetinaMotionOptions saccadeRetinaMotion()
{
  RetinaMotionOptions options;
  options.jerks_per_s = 0.3;
  options.jerk_shortest_mm = 0.5;
  options.jerk_longest_mm = 1.3;
  options.jerk_ms = 40.0;
  return options;
}

}  // namespace

const std::vector<const char*>& retinaMotionNames()
{
  static const std::vector<const char*> names = {"paper", "in_situ", "jerky", "saccade"};
  return names;
}

RetinaMotionOptions retinaMotionOptions(const std::string& name)
{
  if (name == "paper") return paperRetinaMotion();
  if (name == "in_situ") return {};
  if (name == "jerky") return jerkyRetinaMotion();
  if (name == "saccade") return saccadeRetinaMotion();
  throw std::invalid_argument("motion '" + name + "' is not known; paper, in_situ, jerky and saccade are");
}

}  // namespace eyeslam::simulation
