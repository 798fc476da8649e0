// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "eyeslam/fixtures/virtual_fixtures.h"
#include "support/random_hand.h"
#include "support/random_vessels.h"

namespace eyeslam::support {

/// `guided`: standoff, soft curve, motion scaling and three drawn zones in force at once. `kept_out`: vessels are kept
/// out of, with a hand that wanders across them.
enum class Aid { guided, kept_out };

/// A trembling hand and a moving retina over a map of so many trees of vessels; equally dense whatever its size.
class FixtureScene {
 public:
  FixtureScene(int trees, Aid aid, std::uint32_t seed = 1)
  {
    std::mt19937 random(seed);
    const double side_px = 500.0 * std::sqrt(static_cast<double>(trees));
    const RandomVessels grown = randomVesselGraph(random, trees, side_px);
    for (const fixtures::Vessel& vessel : grown.vessels) points_ += vessel.points.size();
    fixtures::VirtualFixturesOptions options;
    options.keep_out.vessels = aid == Aid::kept_out;
    options.keep_out.margin_um = 100.0;
    options.scaling.least = aid == Aid::guided ? 0.5 : 1.0;
    fixtures_ = std::make_unique<fixtures::VirtualFixtures>(options);
    fixtures_->adopt(std::make_shared<const fixtures::CenterlineIndex>(grown.vessels, 5.0), 0);
    fixtures::CurveFixtureOptions soft;
    soft.compliance.lambda = 0.1;
    if (aid == Aid::guided) addZones();
    if (aid == Aid::guided)
      fixtures_->assign(
          {fixtures::PlaneFixture::standoff(200e-6, fixtures::PlaneSide::floor), fixtures::CurveFixture(soft)});
    const double reach = 0.3 * side_px * 5e-6;
    RandomHand hand(random, Eigen::Vector3d(0.0, 0.0, -300e-6), reach, 2e-3, 80e-6);
    WanderingRetina retina(random, 5e-3);
    for (int i = 0; i < kCycles; ++i) {
      const Eigen::Isometry3d pose = retina.step(1e-3);
      inputs_.push_back({pose * hand.step(1e-3), pose, 1e-3, i % 3000 < 2900, 0});
    }
  }

  /// The next cycle, from the first again after the last.
  const fixtures::FixtureOutput& next() { return fixtures_->evaluate(inputs_[at_++ % inputs_.size()]); }
  /// Of all centrelines.
  std::size_t points() const { return points_; }

 private:
  static constexpr int kCycles = 20000;

  void addZones()
  {
    for (std::size_t i = 0; i < 3; ++i) {
      fixtures::KeepOutZone zone;
      zone.count = 8;
      const Eigen::Vector2d centre(6e-4 * static_cast<double>(i) - 6e-4, 5e-4);
      for (std::size_t k = 0; k < zone.count; ++k) {
        const double angle = 2.0 * M_PI * static_cast<double>(k) / static_cast<double>(zone.count);
        zone.corners[k] = centre + 2e-4 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      }
      fixtures_->keepOut().add(zone);
    }
  }

  std::unique_ptr<fixtures::VirtualFixtures> fixtures_;
  std::vector<fixtures::FixtureInput> inputs_;
  std::size_t points_ = 0, at_ = 0;
};

}  // namespace eyeslam::support
