// SPDX-License-Identifier: GPL-3.0-or-later
#include "guidance/fixture_field.h"

#include <cmath>

#include "eyeslam/simulation/loop_period.h"

namespace eyeslam::apps {

namespace {

constexpr int kCycles = 400;  // a bead at its slowest has come to rest

// The goal of a hand that comes to a place and stays there; the hand itself when no vessel takes hold of it.
Eigen::Vector3d goalAtRest(const fixtures::CenterlineIndex& vessels, const fixtures::CurveFixtureOptions& options,
                           const Eigen::Vector3d& hand)
{
  fixtures::CurveFixture fixture(options);
  Eigen::Vector3d goal = hand;
  for (int i = 0; i < kCycles; ++i) {
    goal = fixtures::Composition(hand).with(fixture.constrain({hand, simulation::kPeriod_s, vessels})).goal();
    if (!fixture.following()) return hand;
  }
  return goal;
}

}  // namespace

std::vector<files::FieldArrow> fixtureField(const fixtures::CenterlineIndex& vessels, double um_per_px,
                                            const fixtures::CurveFixtureOptions& options,
                                            const Eigen::Vector2d& middle_px, double width_px, double spacing_px)
{
  const double m_per_px = um_per_px * 1e-6;
  const Eigen::Vector2d corner = middle_px - Eigen::Vector2d::Constant(width_px / 2.0);
  const double row_px = spacing_px * std::sqrt(0.75);
  std::vector<files::FieldArrow> field;
  for (int row = 0; row * row_px < width_px; ++row) {
    for (double x = (row % 2 == 0 ? 0.25 : 0.75) * spacing_px; x < width_px; x += spacing_px) {
      const Eigen::Vector2d hand_px = corner + Eigen::Vector2d(x, (row + 0.5) * row_px);
      const Eigen::Vector3d hand(hand_px.x() * m_per_px, hand_px.y() * m_per_px, 0.0);
      const Eigen::Vector3d goal = goalAtRest(vessels, options, hand);
      if (goal != hand) field.push_back({hand_px, goal.head<2>() / m_per_px});
    }
  }
  return field;
}

}  // namespace eyeslam::apps
