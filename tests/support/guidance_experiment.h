// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "eyeslam/fixtures/virtual_fixtures.h"
#include "support/random_hand.h"
#include "support/random_vessels.h"

namespace eyeslam::support {

using Index = std::shared_ptr<const fixtures::CenterlineIndex>;

inline constexpr double kUmPerPx = 5.0, kPx = kUmPerPx * 1e-6;
inline constexpr double kCycle = 1e-3;      // s
inline constexpr double kGoalStep = 20e-6;  // m, of the guard in a cycle
inline constexpr double kRounding = 1e-10;  // m
inline constexpr std::uint64_t kMap = 77;

inline Index indexOf(const std::vector<fixtures::Vessel>& vessels)
{
  return std::make_shared<const fixtures::CenterlineIndex>(vessels, kUmPerPx);
}
inline Index straightVessel() { return indexOf({vesselThrough(1, {{-300.0, 0.0}, {300.0, 0.0}}, {-1, -1})}); }

inline fixtures::CurveFixtureOptions curveOptions(double lambda)
{
  fixtures::CurveFixtureOptions options;
  options.compliance.lambda = lambda;
  return options;
}

inline fixtures::FixtureInput input(const Eigen::Vector3d& null,
                                    const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity(), bool tracked = true)
{
  return {null, pose, kCycle, tracked, kMap};
}

/// A random experiment: hand, retina, maps that come anew, losses; `check` sees every cycle.
struct Experiment {
  double retina_speed = 5e-3;
  double hand_speed = 0.5e-3;
  bool updates = true;  // of the map, each half second
  bool losses = true;   // of the retina, now and then
  int cycles = 6000;

  template <class Check>
  void run(fixtures::VirtualFixtures& guide, std::mt19937& random, const Check& check) const
  {
    RandomVessels grown = randomVesselGraph(random, 6, 1000.0);
    Index index = indexOf(grown.vessels);
    guide.adopt(index, kMap);
    RandomHand hand(random, Eigen::Vector3d(0.0, 0.0, -300e-6), 1.5e-3, hand_speed, 100e-6);
    WanderingRetina retina(random, retina_speed);
    bool tracked = true;
    for (int i = 0; i < cycles && !testing::Test::HasFatalFailure(); ++i) {
      if (updates && i % 500 == 499) {
        grown = updatedVessels(grown, random, 0.9, 0.02);
        index = indexOf(grown.vessels);
        guide.adopt(index, kMap);
      }
      if (losses && random() % (tracked ? 2000 : 400) == 0) tracked = !tracked;
      const Eigen::Isometry3d pose = retina.step(kCycle);
      const fixtures::FixtureInput in = input(pose * hand.step(kCycle), pose, tracked || !losses);
      check(in, *index, guide.evaluate(in));
    }
  }
};

}  // namespace eyeslam::support
