// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/fixtures/burn_plan.h"
#include "eyeslam/fixtures/centerline_index.h"
#include "eyeslam/fixtures/vessel_graph.h"
#include "eyeslam/fixtures/vessel_graph_options.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/map_assembler.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/retina/options.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::servo {

struct PreparationOptions {
  double period_ms = 500.0;
  double scale_step = 0.03;
  double scale_tolerance = 0.03;
  fixtures::VesselGraphOptions graph;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("period_ms", self.period_ms, Range{0.0, 10000.0}, "ms",
                  "a map that changes is taken in no more often; source: 25 ms of CPU a time, vessel graph");
    visitor.field(
        "scale_step", self.scale_step, Range{0.0, 0.5}, "",
        "a map's um per px that differs by less changes nothing; source: within the tolerance of contracts 1");
    visitor.field("scale_tolerance", self.scale_tolerance, Range{0.0, 0.5}, "",
                  "by which a plan's um per px may differ from the map's; source: contracts 1, 3 %");
    visitor.group("graph", self.graph);
  }
};

/// What the newest map says of a target.
struct TargetVerdict {
  retina::Reason reason = retina::Reason::target_invalid;  ///< why it must not be burnt; none when it may
  double clearance = 0.0;                                  ///< m, edge of the burn to the nearest vessel's edge
};

/// A plan that somebody proposed, in its own order.
struct ProposedPlan {
  std::shared_ptr<const fixtures::BurnPlan> plan;  ///< null before any; shared by all preparations with it
  messaging::Hash hash{};                          ///< of its contents, as this program calculates it
  std::int64_t map_id = 0;                         ///< of the map that it was made on
  std::shared_ptr<const burn_plan_t> message;      ///< the same as it came, with the states of its targets
};

/// All that takes longer than a cycle, made outside the loop and never changed afterwards. Shared by who made it and
/// the loop that uses it.
struct Preparation {
  std::int64_t map_id = 0;       ///< as in retina_pose_t; 0 before the first whole map
  std::int64_t map_version = 0;  ///< of the newest tile in it
  /// Nominal scale of the retina frame: everything that is in metres of it uses this very number. 0 = unknown, then
  /// there are no vessels. It stays while the map's own differs by less than `scale_step`.
  double um_per_px = 0.0;
  std::shared_ptr<const fixtures::CenterlineIndex> vessels;  ///< retina frame; null before the first whole map

  ProposedPlan proposed;
  retina::Reason plan_reason = retina::Reason::plan_not_in_force;  ///< why nothing of it may be burnt; none when it may
  std::vector<TargetVerdict> verdicts;  ///< of each target of the plan, against this map; empty unless it may
};

/// Hears the map and the plan and prepares them for the loop. Has a link of its own, so that the loop's hears messages
/// of fixed size only. Allocates; not for the loop.
///
///   PreparationDesk desk({}, link);
///   link.drain(now);
///   if (desk.work(now)) hand(desk.newest());
class PreparationDesk {
 public:
  /// @param link  must outlive it
  PreparationDesk(const PreparationOptions& options, messaging::Link& link);
  // The subscriptions hold its address.
  PreparationDesk(const PreparationDesk&) = delete;
  PreparationDesk& operator=(const PreparationDesk&) = delete;

  /// After the link was drained: takes in what came. Some 30 ms where the map has changed.
  /// @return whether newest() is another one now
  bool work(const messaging::ReceiveTime& now);
  /// Never null.
  std::shared_ptr<const Preparation> newest() const { return newest_; }

  /// Tiles and plans that could not be used.
  std::int64_t refused() const { return refused_; }
  const messaging::MapAssembler& maps() const { return maps_; }

 private:
  void take(const vessel_map_t& tile);
  void take(const burn_plan_t& plan);
  bool mapIsDue(std::int64_t monotonic) const;
  void takeMap(Preparation& next);
  void judgePlan(Preparation& next) const;

  PreparationOptions options_;
  messaging::MapAssembler maps_;
  fixtures::VesselGraph graph_;
  messaging::Subscription<vessel_map_t> tiles_;
  messaging::Subscription<burn_plan_t> plans_;
  ProposedPlan proposed_;
  bool tiles_came_ = false;
  bool plan_came_ = false;
  std::optional<std::int64_t> map_taken_;  // monotonic us
  std::int64_t refused_ = 0;
  std::shared_ptr<const Preparation> newest_;  // shared with the loop, which may hold an older one
};

}  // namespace eyeslam::servo
