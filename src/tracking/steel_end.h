// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <optional>

#include "eyeslam/tracking/tint_sampler.h"

namespace eyeslam::tracking {

/// Where steel ends on a line of sight.
struct SteelEnd {
  double at = 0.0;
  double contrast = 0.0;  ///< share of the steel's blue that what lies ahead does not explain; 0.8 before plain retina
};

/// Sharpens a rough end of steel: it lies where the blue that the colour ahead does not explain has fallen to half. So
/// a blur moves it neither way, nor does a shadow or a burn ahead, which change how much of a mixed px the steel is
/// given.
/// @param profile  the Tint at a distance; steel before `rough`, something else behind it
/// @param step     about a px of the instrument
/// @return nothing when the profile never falls through its half
template <class Profile>
std::optional<SteelEnd> sharpenSteelEnd(const Profile& profile, double rough, double step)
{
  Tint ahead, behind;
  for (int i = 3; i < 6; ++i) {
    const Tint far = profile(rough + (i + 1) * step), near = profile(rough - (i - 1) * step);
    ahead = {ahead.blue + far.blue / 3.0F, ahead.red + far.red / 3.0F};
    behind = {behind.blue + near.blue / 3.0F, behind.red + near.red / 3.0F};
  }
  const float share = ahead.blue / std::max(ahead.red, 1.0F);
  const float whole = behind.excess(share);
  if (whole <= 0.0F) return std::nullopt;
  float before = whole;
  for (int i = -3; i < 6; ++i) {
    const float now = profile(rough + i * step).excess(share);
    if (now <= 0.5F * whole) {
      const double part = (before - 0.5 * whole) / std::max(before - now, 1e-3F);
      return SteelEnd{rough + step * (i - 1.0 + std::clamp(part, 0.0, 1.0)), whole / std::max(behind.blue, 1.0F)};
    }
    before = now;
  }
  return std::nullopt;
}

}  // namespace eyeslam::tracking
