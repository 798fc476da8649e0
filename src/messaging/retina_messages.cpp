// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/retina_messages.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "eyeslam/messaging/field_copy.h"

namespace eyeslam::messaging {
namespace {

// 16 million cells, fifty fields of view: a map is allocated at the size that its first tile claims.
constexpr std::int64_t kMostMapCells = std::int64_t{1} << 24U;

bool liesInItsMap(const vessel_map_t& tile)
{
  const auto fits = [](std::int64_t first, std::int64_t cells, std::int64_t all) {
    return first >= 0 && cells >= 1 && cells <= MapTileCycle::kTile && first + cells <= all;
  };
  return fits(tile.column, tile.width, tile.map_width) && fits(tile.row, tile.height, tile.map_height) &&
         std::int64_t{tile.map_width} * tile.map_height <= kMostMapCells &&
         std::int64_t{tile.cells} == std::int64_t{tile.width} * tile.height;
}

template <class Copy, class Message, class Stamp>
void listFrame(Copy& copy, Message& message, Stamp& frame)
{
  copy.number(message.utime, frame.utime, kNotNegative);
  copy.number(message.frame, frame.frame, kNotNegative);
  copy.number(message.exposure, frame.exposure, {0.0, 60.0});
}

int tilesAlong(int cells) { return (cells + MapTileCycle::kTile - 1) / MapTileCycle::kTile; }

void describeMap(const retina::VesselMap& map, vessel_map_t& tile)
{
  tile.map_version = static_cast<std::int64_t>(map.version);
  tile.map_width = map.width;
  tile.map_height = map.height;
  tile.origin_x_px = map.origin_x;
  tile.origin_y_px = map.origin_y;
  tile.px_per_cell = map.px_per_cell;
  tile.um_per_px = map.um_per_px;
}

void copyCells(const retina::VesselMap& map, const std::vector<std::uint8_t>& cells, const vessel_map_t& tile,
               std::vector<std::uint8_t>& target)
{
  target.resize(static_cast<std::size_t>(tile.cells));
  auto to = target.begin();
  for (int row = 0; row < tile.height; ++row) {
    const auto from = cells.begin() + static_cast<std::ptrdiff_t>(map.index(tile.column, tile.row + row));
    to = std::copy_n(from, tile.width, to);
  }
}

bool isWhole(const ImagePoint& point)
{
  return point.present || (point.position_px.isZero(0.0) && point.covariance.isZero(0.0));
}

bool isWhole(const InstrumentSight& sight)
{
  return isWhole(sight.tip) && isWhole(sight.spot) &&
         (sight.tip.present || (sight.shaft_angle == 0.0 && sight.shaft_width_px == 0.0));
}

}  // namespace

template <>
struct Listing<retina_pose_t> {
  template <class Copy, class Message, class Pose>
  static void list(Copy& copy, Message& message, Pose& pose)
  {
    listFrame(copy, message, pose.frame);
    copy.flag(message.tracked, pose.motion.tracked);
    copy.reason(message.reason, pose.motion.reason);
    copy.number(message.x_px, pose.motion.map_T_frame.x, kImage_px);
    copy.number(message.y_px, pose.motion.map_T_frame.y, kImage_px);
    copy.number(message.theta, pose.motion.map_T_frame.theta, kAngle);
    copy.number(message.scale, pose.motion.map_T_frame.scale, kScale);
    copy.number(message.velocity_x_px, pose.motion.velocity.x(), kAnyNumber);
    copy.number(message.velocity_y_px, pose.motion.velocity.y(), kAnyNumber);
    copy.number(message.velocity_theta, pose.motion.velocity.z(), kAnyNumber);
    copy.require(pose.motion.tracked || pose.motion.velocity.isZero(0.0));
    copy.covariance(message.covariance, pose.motion.covariance);
    copy.number(message.map_id, pose.map.id, kAnyNumber);
    copy.number(message.map_version, pose.map.version, kNotNegative);
    copy.number(message.um_per_px, pose.map.um_per_px, kUmPerPx);
  }
};
template struct ListedConversion<retina_pose_t, RetinaPose>;

template <>
struct Listing<tool_tip_t> {
  template <class Copy, class Message, class Sight>
  static void list(Copy& copy, Message& message, Sight& sight)
  {
    listFrame(copy, message, sight.frame);
    copy.flag(message.tip_present, sight.tip.present);
    copy.number(message.tip_x_px, sight.tip.position_px.x(), kImage_px);
    copy.number(message.tip_y_px, sight.tip.position_px.y(), kImage_px);
    copy.covariance(message.tip_covariance, sight.tip.covariance);
    copy.number(message.shaft_angle, sight.shaft_angle, kAngle);
    copy.number(message.shaft_width_px, sight.shaft_width_px, kNotNegative);
    copy.flag(message.spot_present, sight.spot.present);
    copy.number(message.spot_x_px, sight.spot.position_px.x(), kImage_px);
    copy.number(message.spot_y_px, sight.spot.position_px.y(), kImage_px);
    copy.covariance(message.spot_covariance, sight.spot.covariance);
    copy.require(isWhole(sight));
  }
};
template struct ListedConversion<tool_tip_t, InstrumentSight>;

bool Conversion<vessel_map_t>::hasItsLengths(ByteWalk walk)
{
  constexpr int kMostCells = MapTileCycle::kTile * MapTileCycle::kTile;
  constexpr std::int64_t kBeforeCells = 6 * 8 + 2 * 4 + 4 * 8 + 4 * 4;
  constexpr std::int64_t kTag = 16;
  std::int64_t cells = 0;
  walk.fields(kBeforeCells).count(cells, 1, kMostCells);
  return walk.fields(3 * cells + kTag).isAtEnd();
}

retina::Reason Conversion<vessel_map_t>::read(const vessel_map_t& message, vessel_map_t& tile)
{
  for (const double number : {message.origin_x_px, message.origin_y_px, message.px_per_cell, message.um_per_px}) {
    if (!std::isfinite(number)) return retina::Reason::not_finite;
  }
  const bool possible = message.px_per_cell >= 0.01 && message.px_per_cell <= 100.0 && message.um_per_px >= 0.0 &&
                        std::abs(message.origin_x_px) <= kImage_px.highest &&
                        std::abs(message.origin_y_px) <= kImage_px.highest && message.map_version >= 0;
  if (!possible || !liesInItsMap(message)) return retina::Reason::out_of_range;
  tile = message;
  return retina::Reason::none;
}

int MapTileCycle::tiles(const retina::VesselMap& map) { return tilesAlong(map.width) * tilesAlong(map.height); }

bool MapTileCycle::next(const retina::VesselMap& map, std::int64_t map_id, std::int64_t utime, vessel_map_t& tile)
{
  if (map.empty()) return false;
  const int number = next_ % tiles(map);
  next_ = number + 1;
  describeMap(map, tile);
  tile.utime = utime;
  tile.map_id = map_id;
  tile.column = number % tilesAlong(map.width) * kTile;
  tile.row = number / tilesAlong(map.width) * kTile;
  tile.width = std::min(kTile, map.width - tile.column);
  tile.height = std::min(kTile, map.height - tile.row);
  tile.cells = tile.width * tile.height;
  copyCells(map, map.probability, tile, tile.probability);
  copyCells(map, map.calibre_px, tile, tile.calibre_px);
  copyCells(map, map.seen, tile, tile.seen);
  return true;
}

}  // namespace eyeslam::messaging
