// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

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
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();    ///< of (x, y, theta): px/s, rad/s
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, theta): px^2, px rad, rad^2
};

/// A point seen in the image, full-resolution px.
struct ImagePoint {
  bool present = false;
  Eigen::Vector2d position_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< px^2
};

/// Tip and shaft of the instrument, and the aiming beam's spot.
struct InstrumentSight {
  ImagePoint tip;
  double shaft_angle = 0.0;  ///< rad: where the tip points, image axes
  double shaft_width_px = 0.0;
  ImagePoint spot;
};

/// Messages without what a Publisher fills.
retina_pose_t retinaPoseMessage(const FrameStamp& frame, const MapStamp& map, const RetinaMotion& motion);
tool_tip_t toolTipMessage(const FrameStamp& frame, const InstrumentSight& sight);

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
