// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>

#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::trials {

/// Classes of calibre in which vessels and the burns that touch them are told apart: below 20 um, to 50 um, and from
/// there on, where no burn may lie (issue 17).
constexpr std::array<double, 2> kCalibreEdges_m{20e-6, 50e-6};
constexpr std::array<const char*, 3> kCalibreClasses{"below_20_um", "20_to_50_um", "50_um_or_more"};
std::size_t calibreClass(double calibre_m);

/// How a map compares with the truth where it has seen the retina.
struct MapCoverage {
  /// Share of the true vessels' area that is vessel in the map, by the vessels' calibre; none where no such vessel is.
  std::array<std::optional<double>, 3> coverage;
  /// Share of the map's vessel cells that lie on a true vessel or within a cell of one.
  std::optional<double> precision;
};

/// @param truth    all true vessels, um_per_px known
/// @param found_T  from the truth's map frame (full-resolution px) to that of `found`
MapCoverage compareMap(const retina::VesselMap& found, const retina::VesselMap& truth,
                       const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& found_T);

}  // namespace eyeslam::trials
