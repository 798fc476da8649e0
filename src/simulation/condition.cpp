// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/condition.h"

#include <stdexcept>

namespace eyeslam::simulation {

namespace {

// In vivo: the defaults of the options are this condition.
Condition inVivo(const char* name, const char* motion)
{
  Condition result;
  result.name = name;
  result.motion = eyeMotionOptions(motion);
  return result;
}

Condition paper()
{
  Condition result = inVivo("paper", "smooth");
  result.motion.drift_px = 60.0;
  result.motion.rotation_deg = 4.0;
  result.tissue.um_per_px = 5.6;
  result.tissue.screen = 0.045;
  result.tissue.contrast = 0.95;
  result.microscope.optics.defocus_px = 0.7;
  result.microscope.optics.defocus_change_px = 0.1;
  result.motion.drift_hz = 0.22;
  result.microscope.illumination.rim_radius_px = 0.0;
  result.microscope.illumination.floor = 0.9;
  result.microscope.illumination.gain = 0.92;
  result.microscope.illumination.wander_px = 10.0;
  result.microscope.blooms.count = 0;
  result.microscope.instrument.present_fraction = 0.1;
  result.microscope.optics.white_green = 1.05;
  result.microscope.sensor.shot_noise = 0.18;
  return result;
}

Condition porcine()
{
  Condition result = inVivo("porcine", "jerky");
  result.motion.rotation_deg = 5.0;
  result.motion.jerk_ms = 90.0;
  result.motion.jerk_rotation_deg = 1.0;
  result.motion_factor = 2.0;
  result.tissue.um_per_px = 3.6;
  result.tissue.contrast = 0.5;
  IlluminationOptions& light = result.microscope.illumination;
  light.gain = 1.05;
  light.cone_px = 300.0;
  light.floor = 0.3;
  light.rim_radius_px = 397.0;
  result.microscope.optics.defocus_px = 1.5;
  result.microscope.optics.white_green = 0.9;
  result.microscope.instrument.present_fraction = 1.0;
  result.microscope.instrument.narrowest_px = 58.0;
  result.microscope.instrument.widest_px = 72.0;
  result.microscope.sensor.read_noise = 2.7;
  result.microscope.sensor.shot_noise = 0.32;
  return result;
}

Condition laser()
{
  Condition result = inVivo("laser", "in_situ");
  result.microscope.instrument.present_fraction = 1.0;
  result.microscope.instrument.widest_px = 32.0;
  result.microscope.laser.every_frames = 25;
  return result;
}

Condition blackout()
{
  Condition result = inVivo("blackout", "jerky");
  result.motion.drift_px = 30.0;
  result.motion.jerk_interval_s = 3.0;
  result.microscope.illumination.blackouts = 3;
  result.microscope.instrument.present_fraction = 0.0;
  return result;
}

Condition plain()
{
  Condition result = inVivo("plain", "jerky");
  result.tissue.textured = false;
  result.tissue.um_per_px = 5.0;
  result.microscope.blooms.count = 0;
  result.microscope.instrument.present_fraction = 0.25;
  return result;
}

Condition excursion()
{
  Condition result = inVivo("excursion", "excursion");
  result.tissue.um_per_px = 5.6;
  return result;
}

Condition hd()
{
  Condition result = inVivo("hd", "jerky");
  result.width = 1920;
  result.height = 1080;
  result.microscope.illumination.rim_radius_px = 405.0;
  return result;
}

}  // namespace

const std::vector<const char*>& conditionNames()
{
  static const std::vector<const char*> names = {"human",    "paper", "porcine", "laser",     "saccade",
                                                 "blackout", "plain", "deform",  "excursion", "hd"};
  return names;
}

Condition condition(const std::string& name)
{
  if (name == "human") return inVivo("human", "jerky");
  if (name == "paper") return paper();
  if (name == "porcine") return porcine();
  if (name == "laser") return laser();
  if (name == "saccade") return inVivo("saccade", "saccade");
  if (name == "blackout") return blackout();
  if (name == "plain") return plain();
  if (name == "deform") return inVivo("deform", "scaling");
  if (name == "excursion") return excursion();
  if (name == "hd") return hd();
  throw std::invalid_argument(
      "condition '" + name +
      "' is not known; human, paper, porcine, laser, saccade, blackout, plain, deform, excursion and hd are");
}

}  // namespace eyeslam::simulation
