// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/fixtures/virtual_fixtures.h"
#include "eyeslam/simulation/hand.h"
#include "eyeslam/simulation/retina_motion.h"
#include "eyeslam/simulation/traced_path.h"

namespace eyeslam::apps {

/// What helps the hand: nothing, or a curve fixture.
enum class Aid { none, soft, hard };

struct GuidedTracingOptions {
  std::string motion = "in_situ";  ///< as `retinaMotionOptions` knows it
  std::uint64_t seed = 0;
  Aid aid = Aid::hard;
  double lambda = 0.1;                       ///< of the soft fixture
  double speed_mm_s = 0.4;                   ///< along the path; source: loop study, 1
  fixtures::CurveFixtureOptions curve = {};  ///< but for its lambda
};

/// One millisecond of a tracing.
struct TracingStep {
  double t_s = 0.0;
  simulation::RetinaPose world_T_retina;
  Eigen::Vector3d null = Eigen::Vector3d::Zero();  ///< world, m
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();   ///< world, m: the goal itself, or the null without an aid
  Eigen::Vector3d tip_retina = Eigen::Vector3d::Zero();
  simulation::PathTarget target;  ///< where the surgeon means to be; retina frame
};

/// A simulated surgeon traces a path on a moving retina, by the loop study's model, with or without a fixture. The
/// retina's pose is the true one and the tip goes where it is told, so that what is seen is what guidance itself does.
///
///   GuidedTracing tracing({"in_situ", seed, Aid::soft}, vessels, path, centre);
///   while (t < 20.0) record(tracing.step().tip_retina);
class GuidedTracing {
 public:
  enum class Retina { tracked, lost };

  /// @param vessels  what the fixture follows
  /// @param path     what the surgeon follows, retina frame, m
  /// @param centre   what the retina turns about, retina frame, m
  /// @throws std::invalid_argument for an unknown motion, or a path without length
  GuidedTracing(const GuidedTracingOptions& options, std::shared_ptr<const fixtures::CenterlineIndex> vessels,
                std::vector<Eigen::Vector3d> path, const Eigen::Vector3d& centre);

  const TracingStep& step(Retina seen = Retina::tracked);
  /// A newer map takes the place of the one in use.
  void adopt(std::shared_ptr<const fixtures::CenterlineIndex> vessels);

  const fixtures::FixtureOutput& fixture() const { return fixture_; }
  const simulation::TracedPath& path() const { return path_; }
  const simulation::Hand& hand() const { return hand_; }

 private:
  GuidedTracingOptions options_;
  simulation::TracedPath path_;
  simulation::Hand hand_;
  simulation::RetinaMotion retina_;
  fixtures::VirtualFixtures fixtures_;
  fixtures::FixtureOutput fixture_;
  std::uint64_t map_id_ = 1;
  std::int64_t steps_ = 0;
  TracingStep now_;
};

/// A path of the map frame (px) in the retina frame (m), at a height above the retina.
std::vector<Eigen::Vector3d> ontoRetina(const std::vector<Eigen::Vector2d>& path_px, double um_per_px, double height);

}  // namespace eyeslam::apps
