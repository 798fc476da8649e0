// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "eyeslam/files/guidance_drawing.h"
#include "eyeslam/fixtures/curve_fixture.h"

namespace eyeslam::apps {

/// Where a curve fixture puts the goal for hands at rest, over a square of the map: hexagonal pattern, row by row;
/// hands out of the fixture's reach are left out.
std::vector<files::FieldArrow> fixtureField(const fixtures::CenterlineIndex& vessels, double um_per_px,
                                            const fixtures::CurveFixtureOptions& options,
                                            const Eigen::Vector2d& middle_px, double width_px, double spacing_px);

}  // namespace eyeslam::apps
