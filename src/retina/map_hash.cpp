// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/retina/map_hash.h"

#include "eyeslam/retina/sha256.h"

namespace eyeslam::retina {

std::string hashOf(const VesselMap& map)
{
  Sha256 sha;
  sha.addNumber(static_cast<std::uint32_t>(map.width));
  sha.addNumber(static_cast<std::uint32_t>(map.height));
  sha.addDouble(map.origin_x);
  sha.addDouble(map.origin_y);
  sha.addDouble(map.px_per_cell);
  sha.add(map.probability.data(), map.probability.size());
  sha.add(map.seen.data(), map.seen.size());
  return hexOf(sha.digest());
}

}  // namespace eyeslam::retina
