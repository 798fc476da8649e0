// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "eyeslam/fixtures/virtual_fixtures.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/retina/options.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/servo/preparation.h"
#include "eyeslam/servo/servo_cycle.h"

namespace eyeslam::servo {

struct GuidanceOptions {
  /// A vessel is kept: a hand leans 150 um RMS per axis (loop study, 1).
  GuidanceOptions();

  fixtures::VirtualFixturesOptions fixtures;
  fixtures::PointFixtureOptions point;
  fixtures::CurveFixtureOptions vessel;
  double scaling_least = 0.25;
  std::string standoff_side = "hold";

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.group("fixtures", self.fixtures);
    visitor.group("point", self.point);
    visitor.group("vessel", self.vessel);
    visitor.field("scaling_least", self.scaling_least, Range{0.05, 1.0}, "",
                  "tip motion per hand motion on a vessel, of the fixture `scaling`; source: facts C1.4, T-RO 2013");
    visitor.choice("standoff_side", self.standoff_side, {"hold", "floor"},
                   "whether the tip stays at the height wanted, or may rise from it; source: facts C1.3");
  }
};

/// Where the retina's frame comes from in a cycle.
struct RetinaFrame {
  std::int64_t map_id = 0;  ///< of the newest pose
  double um_per_px = 0.0;   ///< nominal, of map px: makes metres of them; 0 = unknown
  std::int64_t view = 0;    ///< grows when the view was placed anew: places from before are none
};

/// The human's choice of a fixture, put into force: makes virtual fixtures of OPERATOR and the newest preparation, and
/// asks them each cycle. While it is not engaged the goal is the hand, so that fixtures take hold of it softly when it
/// is. Never throws, never allocates.
///
///   const Reason why = guidance.serve(wish, frame);          // none: it can be served
///   guidance.engage(supervisor.guides());
///   const Eigen::Vector3d goal = guidance.goal(outlook);     // retina frame
class Guidance {
 public:
  explicit Guidance(const GuidanceOptions& options = {});

  /// What was prepared outside the loop; must stay until the next one was adopted.
  void adopt(const Preparation* preparation) noexcept;

  /// Takes over what the human wants, in every cycle.
  /// @return why it cannot be served: scale_unknown, map_changed, no_vessel, vessel_unknown, zone_invalid; none
  retina::Reason serve(const messaging::OperatorWish& wish, const RetinaFrame& frame) noexcept;
  /// Whether what is wanted needs a registered camera and a retina in view.
  bool needsRetina() const noexcept { return needs_retina_; }
  /// Whether anything is to guide at all: no fixture and no zone is the hand alone.
  bool guides() const noexcept { return guides_; }

  enum class Engaged { no, yes };
  void engage(Engaged engaged) noexcept;
  /// Of the tip; retina frame, m. Not finite until the fixtures know one.
  Eigen::Vector3d goal(const Outlook& outlook) noexcept;
  /// Who changed the last goal, and why.
  const fixtures::FixtureOutput& output() const noexcept { return output_; }

 private:
  /// What the fixtures in force were made of.
  struct Served {
    messaging::WantedFixture fixture;
    std::int64_t map_id = 0;
    double um_per_px = 0.0;
  };

  retina::Reason whyNot(const messaging::OperatorWish& wish) const noexcept;
  int vesselId(const messaging::WantedFixture& fixture) const noexcept;
  retina::Reason whyNotVessel(const messaging::WantedFixture& fixture) const noexcept;
  bool isInForce(const messaging::WantedFixture& fixture) const noexcept;
  bool speaksOfMap(const messaging::OperatorWish& wish) const noexcept;
  std::shared_ptr<const fixtures::CenterlineIndex> vesselsOfMap() const noexcept;
  void put(const messaging::WantedFixture& fixture) noexcept;
  void assign(const messaging::WantedFixture& fixture) noexcept;
  fixtures::ComplianceOptions soft(fixtures::ComplianceOptions options, double lambda) const noexcept;
  retina::Reason drawZones(const messaging::OperatorWish& wish) noexcept;

  GuidanceOptions options_;
  fixtures::VirtualFixtures fixtures_;
  fixtures::FixtureOutput output_;
  const Preparation* preparation_ = nullptr;
  messaging::WantedFixture wanted_;
  RetinaFrame frame_;
  Served served_;
  bool engaged_ = false;
  bool in_force_ = false;  // the fixture served, not the hand alone
  bool needs_retina_ = false, guides_ = false;
  retina::Reason zones_reason_ = retina::Reason::none;
  int zones_ = 0;
  std::array<messaging::Zone, messaging::OperatorWish::kMostZones> zone_{};
  double zones_um_per_px_ = 0.0;
};

}  // namespace eyeslam::servo
