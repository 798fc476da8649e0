// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::retina {

/// SHA-256 over a map's cells and geometry, 64 hexadecimal digits: the same in files, plans and messages on every
/// machine. Over, little-endian: width and height (int32), origin_x, origin_y, px_per_cell (IEEE 754 double), then the
/// probabilities and the counts of `seen`, row by row. Calibre follows from the cells, um_per_px is a plan's own field,
/// a version is one tracker's own count: none of them is part of it.
std::string hashOf(const VesselMap& map);

}  // namespace eyeslam::retina
