// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/preparation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "eyeslam/fixtures/burn_planner.h"
#include "eyeslam/servo/plan_messages.h"

namespace eyeslam::servo {

using retina::Reason;

namespace {

bool differs(double value, double from, double tolerance) { return !(std::abs(value / from - 1.0) <= tolerance); }

bool idsDiffer(const burn_plan_t& plan)
{
  std::set<std::int32_t> ids;
  for (const burn_target_t& target : plan.target) ids.insert(target.id);
  return ids.size() == plan.target.size();
}

bool bearsItsHash(const burn_plan_t& plan, const messaging::Hash& hash)
{
  return std::equal(hash.begin(), hash.end(), std::begin(plan.hash));
}

// In the plan's own order. What was refused when it was proposed stays refused: the zones that may have refused it do
// not travel, and what a human approved without it must not come back.
Reason judgeTargets(const fixtures::BurnPlan& proposed, const retina::VesselMap& map,
                    std::vector<TargetVerdict>& verdicts)
{
  fixtures::BurnPlan plan = proposed;
  plan.map.px_per_cell = map.px_per_cell;  // does not travel: the map's id says that it is the same map
  std::map<int, TargetVerdict> by_id;
  try {
    for (const fixtures::BurnTarget& target : fixtures::revalidated(plan, map).targets) {
      by_id[target.id] = {target.reason, 1e-6 * target.clearance_um};
    }
  } catch (const fixtures::PlanError&) {
    return Reason::out_of_range;
  }
  for (const fixtures::BurnTarget& target : proposed.targets) {
    TargetVerdict verdict = by_id[target.id];
    if (!target.valid()) verdict.reason = target.reason;
    verdicts.push_back(verdict);
  }
  return Reason::none;
}

}  // namespace

PreparationDesk::PreparationDesk(const PreparationOptions& options, messaging::Link& link)
    : options_(options),
      graph_(options.graph),
      tiles_(link, [this](const vessel_map_t& tile, const messaging::MessageHeader&) { take(tile); }),
      plans_(link, [this](const burn_plan_t& plan, const messaging::MessageHeader&) { take(plan); }),
      newest_(std::make_shared<const Preparation>())
{}

void PreparationDesk::take(const vessel_map_t& tile)
{
  if (maps_.add(tile) != Reason::none) {
    ++refused_;
  } else {
    tiles_came_ = true;
  }
}

void PreparationDesk::take(const burn_plan_t& plan)
{
  if (plan.state != burn_plan_t::PROPOSED) return;  // the servo's own word
  const messaging::Hash hash = planHash(plan);
  if (!bearsItsHash(plan, hash) || !idsDiffer(plan)) {
    ++refused_;
    return;
  }
  if (proposed_.plan && proposed_.hash == hash) return;  // said again, as once a second
  proposed_ = {std::make_shared<const fixtures::BurnPlan>(planOf(plan)), hash, plan.map_id,
               std::make_shared<const burn_plan_t>(plan)};
  plan_came_ = true;
}

bool PreparationDesk::mapIsDue(std::int64_t monotonic) const
{
  // Until a map is whole its vessels end where tiles are missing; once known, it may grow.
  const bool known = maps_.isComplete() || (newest_->map_id != 0 && newest_->map_id == maps_.mapId());
  return tiles_came_ && known &&
         (!map_taken_ || static_cast<double>(monotonic - *map_taken_) >= 1e3 * options_.period_ms);
}

bool PreparationDesk::work(const messaging::ReceiveTime& now)
{
  const bool map_due = mapIsDue(now.monotonic);
  if (!map_due && !plan_came_) return false;
  auto next = std::make_shared<Preparation>(*newest_);
  if (map_due) {
    takeMap(*next);
    map_taken_ = now.monotonic;
    tiles_came_ = false;
  }
  next->proposed = proposed_;
  plan_came_ = false;
  judgePlan(*next);
  newest_ = std::move(next);
  return true;
}

void PreparationDesk::takeMap(Preparation& next)
{
  const retina::VesselMap& map = maps_.map();
  if (next.map_id != maps_.mapId()) graph_ = fixtures::VesselGraph(options_.graph);  // ids belong to one map
  graph_.update(map);
  next.map_id = maps_.mapId();
  next.map_version = static_cast<std::int64_t>(map.version);
  if (differs(map.um_per_px, next.um_per_px, options_.scale_step)) next.um_per_px = map.um_per_px;
  next.vessels.reset();
  if (!(next.um_per_px > 0.0)) return;
  try {
    next.vessels = std::make_shared<const fixtures::CenterlineIndex>(graph_.vessels(), next.um_per_px);
  } catch (const std::invalid_argument&) {  // a scale that puts vessels a metre away
    ++refused_;
    next.um_per_px = 0.0;
  }
}

void PreparationDesk::judgePlan(Preparation& next) const
{
  next.verdicts.clear();
  next.plan_reason = Reason::plan_not_in_force;
  if (!next.proposed.plan || !next.vessels) return;
  const fixtures::BurnPlan& plan = *next.proposed.plan;
  if (next.proposed.map_id != next.map_id) {
    next.plan_reason = Reason::map_changed;
  } else if (differs(plan.um_per_px, next.um_per_px, options_.scale_tolerance)) {
    next.plan_reason = Reason::plan_scale;
  } else {
    next.plan_reason = judgeTargets(plan, maps_.map(), next.verdicts);
  }
}

}  // namespace eyeslam::servo
