// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/retina_messages.h"

#include <algorithm>
#include <vector>

namespace eyeslam::messaging {
namespace {

template <class Matrix>
void writeRows(const Matrix& matrix, double* target)
{
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) *target++ = matrix(row, column);
  }
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

}  // namespace

retina_pose_t retinaPoseMessage(const FrameStamp& frame, const MapStamp& map, const RetinaMotion& motion)
{
  retina_pose_t message{};
  message.utime = frame.utime;
  message.frame = frame.frame;
  message.exposure = frame.exposure;
  message.tracked = motion.tracked;
  message.reason = static_cast<std::int16_t>(motion.reason);
  message.x_px = motion.map_T_frame.x;
  message.y_px = motion.map_T_frame.y;
  message.theta = motion.map_T_frame.theta;
  message.scale = motion.map_T_frame.scale;
  message.velocity_x_px = motion.velocity.x();
  message.velocity_y_px = motion.velocity.y();
  message.velocity_theta = motion.velocity.z();
  writeRows(motion.covariance, message.covariance);
  message.map_id = map.id;
  message.map_version = map.version;
  message.um_per_px = map.um_per_px;
  return message;
}

tool_tip_t toolTipMessage(const FrameStamp& frame, const InstrumentSight& sight)
{
  tool_tip_t message{};
  message.utime = frame.utime;
  message.frame = frame.frame;
  message.exposure = frame.exposure;
  if (sight.tip.present) {
    message.tip_present = 1;
    message.tip_x_px = sight.tip.position_px.x();
    message.tip_y_px = sight.tip.position_px.y();
    message.shaft_angle = sight.shaft_angle;
    message.shaft_width_px = sight.shaft_width_px;
    writeRows(sight.tip.covariance, message.tip_covariance);
  }
  if (sight.spot.present) {
    message.spot_present = 1;
    message.spot_x_px = sight.spot.position_px.x();
    message.spot_y_px = sight.spot.position_px.y();
    writeRows(sight.spot.covariance, message.spot_covariance);
  }
  return message;
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
