// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/map_assembler.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace eyeslam::messaging {
namespace {

using retina::VesselMap;

/// Where cell (0, 0) of a map lies in another, in cells.
struct CellShift {
  int column = 0;
  int row = 0;
};

VesselMap emptyMap(const vessel_map_t& tile)
{
  VesselMap map;
  map.width = tile.map_width;
  map.height = tile.map_height;
  map.origin_x = tile.origin_x_px;
  map.origin_y = tile.origin_y_px;
  map.px_per_cell = tile.px_per_cell;
  const std::size_t cells = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
  map.probability.assign(cells, 0);
  map.calibre_px.assign(cells, 0);
  map.seen.assign(cells, 0);
  return map;
}

// A map's grid follows what its anchor learns, some 0.01 px at a time (tracking/anchor): what was known stays where it
// is, within this share of a cell, until its tile comes again.
constexpr double kSameCell = 0.25;

bool sameShape(const VesselMap& map, const vessel_map_t& tile)
{
  const double tolerance = kSameCell * tile.px_per_cell;
  return map.width == tile.map_width && map.height == tile.map_height && map.px_per_cell == tile.px_per_cell &&
         std::abs(map.origin_x - tile.origin_x_px) <= tolerance &&
         std::abs(map.origin_y - tile.origin_y_px) <= tolerance;
}

// None where the cells of the two do not coincide.
std::optional<CellShift> shiftInto(const VesselMap& from, const VesselMap& to)
{
  const double column = (from.origin_x - to.origin_x) / to.px_per_cell;
  const double row = (from.origin_y - to.origin_y) / to.px_per_cell;
  const bool on_grid = from.px_per_cell == to.px_per_cell && std::abs(column - std::round(column)) <= kSameCell &&
                       std::abs(row - std::round(row)) <= kSameCell;
  if (!on_grid) return {};
  return CellShift{static_cast<int>(std::lround(column)), static_cast<int>(std::lround(row))};
}

void copyOverlap(const std::vector<std::uint8_t>& from, const VesselMap& from_map, const CellShift& shift,
                 std::vector<std::uint8_t>& to, const VesselMap& to_map)
{
  const int first = std::max(0, -shift.column);
  const int last = std::min(from_map.width, to_map.width - shift.column);
  for (int row = std::max(0, -shift.row); first < last && row < std::min(from_map.height, to_map.height - shift.row);
       ++row) {
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(from_map.index(first, row));
    std::copy(begin, begin + (last - first),
              to.begin() + static_cast<std::ptrdiff_t>(to_map.index(first + shift.column, row + shift.row)));
  }
}

}  // namespace

retina::Reason MapAssembler::add(const vessel_map_t& tile)
{
  const auto version = static_cast<std::uint64_t>(tile.map_version);
  if (map_.empty() || tile.map_id != map_id_) {
    begin(tile);
  } else if (version < map_.version) {
    return retina::Reason::out_of_order;
  } else if (!sameShape(map_, tile)) {
    reshape(tile);
  }
  map_.version = version;
  map_.origin_x = tile.origin_x_px;
  map_.origin_y = tile.origin_y_px;
  map_.um_per_px = tile.um_per_px;
  paste(tile);
  return retina::Reason::none;
}

void MapAssembler::begin(const vessel_map_t& tile)
{
  map_id_ = tile.map_id;
  map_ = emptyMap(tile);
  known_.assign(map_.seen.size(), 0);
  unknown_ = known_.size();
}

void MapAssembler::reshape(const vessel_map_t& tile)
{
  VesselMap grown = emptyMap(tile);
  const std::optional<CellShift> shift = shiftInto(map_, grown);
  if (!shift) return begin(tile);
  std::vector<std::uint8_t> known(grown.seen.size(), 0);
  copyOverlap(map_.probability, map_, *shift, grown.probability, grown);
  copyOverlap(map_.calibre_px, map_, *shift, grown.calibre_px, grown);
  copyOverlap(map_.seen, map_, *shift, grown.seen, grown);
  copyOverlap(known_, map_, *shift, known, grown);
  map_ = std::move(grown);
  known_ = std::move(known);
  unknown_ = static_cast<std::size_t>(std::count(known_.begin(), known_.end(), std::uint8_t{0}));
}

void MapAssembler::paste(const vessel_map_t& tile)
{
  for (int row = 0; row < tile.height; ++row) {
    const auto from = static_cast<std::ptrdiff_t>(row) * tile.width;
    const auto to = static_cast<std::ptrdiff_t>(map_.index(tile.column, tile.row + row));
    std::copy_n(tile.probability.begin() + from, tile.width, map_.probability.begin() + to);
    std::copy_n(tile.calibre_px.begin() + from, tile.width, map_.calibre_px.begin() + to);
    std::copy_n(tile.seen.begin() + from, tile.width, map_.seen.begin() + to);
    const auto known = known_.begin() + to;
    unknown_ -= static_cast<std::size_t>(std::count(known, known + tile.width, std::uint8_t{0}));
    std::fill_n(known, tile.width, std::uint8_t{1});
  }
}

}  // namespace eyeslam::messaging
