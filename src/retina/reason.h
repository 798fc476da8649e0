// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string_view>

namespace eyeslam::retina {

/// Why something was refused: one list for files (the word) and messages (the number). Numbers never change meaning.
enum class Reason : std::int16_t {
  none = 0,
  // Tracking
  blackout = 1,        ///< hardly any retina in view: too dark, or covered
  wrong_size = 2,      ///< the frame's size or type differs from the first frame's
  too_few_points = 3,  ///< not enough vessel points to match
  ambiguous = 4,       ///< two places fit alike
  poor_match = 5,      ///< nothing in the map fits
  blurred = 6,         ///< too smeared to start a map from
  searching = 7,       ///< lost; the search of the whole map goes on in the next frame
  // Burn planning: why a target must not be burnt
  near_vessel = 40,  ///< margin and localization error reach a vessel
  near_fovea = 41,   ///< or the zone around the fovea
  near_disc = 42,    ///< or the zone around the optic disc
  in_keep_out = 43,  ///< or a drawn zone
  not_seen = 44,     ///< or a place seen in too few frames to know that there is no vessel
  outside_map = 45,  ///< or the end of the map
  crowded = 46,      ///< nearer to another target than the pattern's spacing
};

/// The word of a reason, as in `trajectory.csv`; empty for `none`.
std::string_view word(Reason reason);

}  // namespace eyeslam::retina
