// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "eyeslam/fixtures/burn_prescription.h"
#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::apps {

/// How many planned burns were looked at, and how many of them are wrong against the very map they were planned on.
struct PlanCheck {
  std::size_t valid = 0;
  std::size_t too_near = 0;   ///< grown by margin and localization error, the disc reaches a vessel cell's square
  double least_gap_um = 0.0;  ///< the smallest distance left over the margin; 0 when none is valid
  double cpu_ms = 0.0;        ///< of planning
};

/// Plans on a map and judges each valid target by brute force: every cell of the neighbourhood, no shortcut shared
/// with the planner. @throws fixtures::PlanError
PlanCheck checkPlan(const retina::VesselMap& map, const fixtures::BurnPrescription& prescription);

/// A manual vessel mask as a perfect map: seen wherever the photograph is not black. @throws files::FileError
retina::VesselMap perfectMap(const std::string& photograph, const std::string& mask, double um_per_px);

/// What a map that a tracker made would have burnt, against the true vessels.
struct BurnRisk {
  std::string sequence;
  int frame = 0;
  int vessel_probability = 128;  ///< from which a cell counts as a vessel
  double coverage = 0.0;         ///< of all labelled centrelines seen, [0, 1], as the judge counts
  double spot_um = 0.0;
  double margin_um = 0.0;
  std::size_t places = 0;       ///< cells of the map where a burn's centre may lie
  std::size_t seen = 0;         ///< cells seen at all
  std::size_t touching = 0;     ///< places whose burn touches a true vessel
  std::size_t touching_6 = 0;   ///< one at least 6 px wide
  std::size_t touching_10 = 0;  ///< one at least 10 px wide
};

/// Every map that eyeslam-track kept of a sequence, for spots of 100 and 200 um and some margins.
/// @param sequence  folder with the truth;  @param track  folder that eyeslam-track wrote
/// @throws files::FileError, std::invalid_argument when there is no vessel picture
std::vector<BurnRisk> studyRisks(const std::string& sequence, const std::string& track);

/// The same with maps that hold every true vessel from some calibre on and nothing else: what is missed then is known.
/// `frame` is the least calibre, px.
std::vector<BurnRisk> studyMissingThinVessels(const std::string& sequence);

}  // namespace eyeslam::apps
