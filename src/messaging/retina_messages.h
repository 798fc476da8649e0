// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "eyeslam/messaging/byte_walk.h"
#include "eyeslam/messaging/conversion.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/retina/vessel_map.h"
#include "eyeslam/retina_pose_t.hpp"
#include "eyeslam/tool_tip_t.hpp"
#include "eyeslam/vessel_map_t.hpp"

namespace eyeslam::messaging {

/// The picture that a message speaks of.
struct FrameStamp {
  std::int64_t utime = 0;  ///< us since 1970, middle of the exposure
  std::int64_t frame = 0;  ///< number, from 0
  double exposure = 0.0;   ///< s, 0 = unknown
};

/// The map that a pose or a tile belongs to.
struct MapStamp {
  std::int64_t id = 0;       ///< changes only when tracking starts anew
  std::int64_t version = 0;  ///< grows
  double um_per_px = 0.0;    ///< of full-resolution map px, 0 = unknown
};

/// Where the view is; full-resolution px, rad, s.
struct RetinaMotion {
  bool tracked = false;
  retina::Reason reason = retina::Reason::none;          ///< why not tracked
  retina::Pose2 map_T_frame;                             ///< the last good one when not tracked
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();    ///< of (x, y, theta): px/s, rad/s; 0 when not tracked
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, theta): px^2, px rad, rad^2
};

/// Where the view is, when, and on which map (RETINA_POSE).
struct RetinaPose {
  FrameStamp frame;
  MapStamp map;
  RetinaMotion motion;
};

/// A point seen in the image, full-resolution px; all zero when absent.
struct ImagePoint {
  bool present = false;
  Eigen::Vector2d position_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< px^2
};

/// Tip and shaft of the instrument, and the aiming beam's spot (TOOL_TIP).
struct InstrumentSight {
  FrameStamp frame;
  ImagePoint tip;
  double shaft_angle = 0.0;     ///< rad: where the tip points, image axes; 0 without a tip
  double shaft_width_px = 0.0;  ///< 0 without a tip
  ImagePoint spot;
};

template <>
struct Conversion<retina_pose_t> : ListedConversion<retina_pose_t, RetinaPose> {};
template <>
struct Conversion<tool_tip_t> : ListedConversion<tool_tip_t, InstrumentSight> {};

/// A tile is its own value; map_assembler.h puts tiles together.
template <>
struct Conversion<vessel_map_t> {
  using Value = vessel_map_t;
  static bool hasItsLengths(ByteWalk walk);
  /// Checks that the tile lies inside its map and the map is of a possible size, and copies it.
  static retina::Reason read(const vessel_map_t& message, vessel_map_t& tile);
};

/// Cuts the vessel map into tiles that fit one UDP fragment and goes through them for ever. Where the map has grown the
/// tiles are numbered anew, and the cycle goes on at the same place of the new numbering or starts again.
class MapTileCycle {
 public:
  /// Cells of a tile in each direction: 3 x 20^2 bytes and the other fields stay below 1,400 bytes.
  static constexpr int kTile = 20;

  /// Fills the next tile. Allocates only until the first full tile.
  /// @param utime  us since 1970, middle of the exposure of the last frame in the map
  /// @return whether there was one: false for an empty map
  bool next(const retina::VesselMap& map, std::int64_t map_id, std::int64_t utime, vessel_map_t& tile);

  /// Messages of a whole cycle.
  static int tiles(const retina::VesselMap& map);

 private:
  int next_ = 0;
};

}  // namespace eyeslam::messaging
