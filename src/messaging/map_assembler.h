// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "eyeslam/retina/reason.h"
#include "eyeslam/retina/vessel_map.h"
#include "eyeslam/vessel_map_t.hpp"

namespace eyeslam::messaging {

/// Puts the tiles of VESSEL_MAP together again, in any order and whenever it begins to listen; what was lost comes in
/// the next cycle. A map that grows keeps what is known of it; one with another id begins anew.
///
///   Subscription<vessel_map_t> tiles(link, [&](const vessel_map_t& tile, const MessageHeader&) { maps.add(tile); });
///   if (maps.isComplete()) use(maps.map());
class MapAssembler {
 public:
  /// Takes a tile that `read` let pass. Allocates where the map begins or grows.
  /// @return none; out_of_order for an older version than the map's
  retina::Reason add(const vessel_map_t& tile);

  /// What is known so far; unknown cells are 0 (`seen` too). Its version is the newest tile's: others may be older by a
  /// cycle.
  const retina::VesselMap& map() const { return map_; }
  /// As in retina_pose_t; 0 before the first tile.
  std::int64_t mapId() const { return map_id_; }
  std::size_t unknownCells() const { return unknown_; }
  bool isComplete() const { return !map_.empty() && unknown_ == 0; }

 private:
  void begin(const vessel_map_t& tile);
  void reshape(const vessel_map_t& tile);
  void paste(const vessel_map_t& tile);

  std::int64_t map_id_ = 0;
  retina::VesselMap map_;
  std::vector<std::uint8_t> known_;  // 1 where a tile brought the cell
  std::size_t unknown_ = 0;
};

}  // namespace eyeslam::messaging
