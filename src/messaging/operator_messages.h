// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "eyeslam/messaging/conversion.h"
#include "eyeslam/operator_t.hpp"

namespace eyeslam::messaging {

/// SHA-256 of a plan or a map.
using Hash = std::array<std::uint8_t, 32>;

enum class WantedMode { standby, ready, assist, laser };
enum class FixtureKind { none, filter, scaling, point, vessel, standoff, calibration };

/// The virtual fixture that the human chose. Map frame, full-resolution px.
struct WantedFixture {
  FixtureKind kind = FixtureKind::none;
  std::int64_t vessel = -1;  ///< id in the vessel graph; -1: the nearest to the point, or of no vessel
  Eigen::Vector2d point_px = Eigen::Vector2d::Zero();  ///< zero unless of a point, or of a vessel without id
  double standoff = 0.0;                               ///< m above the retina, [0, 0.02]; 0 unless standoff
  double lambda = 0.0;                                 ///< [0, 1], share of the hand's departure that passes; 0 = hard
};

/// A region that tip and laser keep out of: a polygon, map frame, full-resolution px.
struct Zone {
  static constexpr int kMostCorners = 16;
  int corners = 0;  ///< [3, kMostCorners]
  Eigen::Matrix<float, 2, kMostCorners> corner_px = Eigen::Matrix<float, 2, kMostCorners>::Zero();  ///< columns (x, y)
};

/// What the human wants now, whole (OPERATOR).
struct OperatorWish {
  static constexpr int kMostZones = 8;

  WantedMode mode = WantedMode::standby;
  bool stop = false;         ///< nothing moves again before `rearmed` grows
  bool arm = false;          ///< pulses are allowed, as far as everything else allows them
  std::int64_t rearmed = 0;  ///< times that the human re-armed in this session
  std::int64_t map_id = 0;   ///< the map that fixture and zones speak of; 0 = of none
  WantedFixture fixture;
  bool plan_approved = false;
  Hash plan_hash{};  ///< of the approved plan; zero unless approved
  int zones = 0;     ///< [0, kMostZones]
  std::array<Zone, kMostZones> zone{};
};

template <>
struct Conversion<operator_t> : ListedConversion<operator_t, OperatorWish> {};

}  // namespace eyeslam::messaging
