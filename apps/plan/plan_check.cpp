// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/plan_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/plan_file.h"
#include "eyeslam/fixtures/burn_planner.h"
#include "eyeslam/retina/reason.h"
#include "plan/plan_report.h"
#include "plan/plan_run.h"

namespace eyeslam::apps {
namespace {

using fixtures::BurnPlan;
using fixtures::BurnTarget;
using Targets = std::vector<BurnTarget>;

// Targets of a plan that may be burnt by it, but not by the other.
Targets lostIn(const BurnPlan& other, const BurnPlan& plan)
{
  std::map<int, BurnTarget> by_id;
  for (const BurnTarget& target : other.targets) by_id.emplace(target.id, target);
  Targets lost;
  for (const BurnTarget& target : plan.targets) {
    const auto found = by_id.find(target.id);
    if (target.valid() && found != by_id.end() && !found->second.valid()) lost.push_back(found->second);
  }
  return lost;
}

std::string idsOf(const Targets& targets)
{
  std::string ids;
  for (const BurnTarget& target : targets) ids += (ids.empty() ? "" : ", ") + std::to_string(target.id);
  return ids;
}

BurnPlan validatedAgain(const PlanArguments& arguments, const BurnPlan& plan, const files::RecordedMap& map)
{
  try {
    BurnPlan renewed = fixtures::revalidated(plan, map.map);
    renewed.map.track = map.track;
    return renewed;
  } catch (const fixtures::PlanError& error) {
    throw files::FileError(fmt::format("{} on {}: {}", arguments.check, map.path, error.what()));
  }
}

void report(const PlanArguments& arguments, const BurnPlan& plan, const BurnPlan& renewed, const Targets& lost)
{
  const Targets regained = lostIn(plan, renewed);
  fmt::print("{}{}", warningsOf(renewed), summaryOf(renewed));
  fmt::print("  map        {}\n", renewed.map.hash == plan.map.hash ? "the plan's own" : "another than the plan's");
  for (const BurnTarget& target : lost) {
    fmt::print("  invalid    {} at ({:.1f}, {:.1f}) px: {}\n", target.id, target.position_px.x(),
               target.position_px.y(), retina::word(target.reason));
  }
  if (!regained.empty()) fmt::print("  now valid  {}\n", idsOf(regained));
  if (!arguments.out.empty()) fmt::print("  written    {}\n", arguments.out);
}

}  // namespace

void checkPlan(const PlanArguments& arguments)
{
  const BurnPlan plan = files::readPlan(arguments.check);
  files::RecordedMap map = mapOf(arguments);
  files::checkSameTrack(plan, arguments.check, map);
  // The scale that the plan was made with was given for this map, which does not know its own.
  if (map.map.um_per_px == 0.0) map.map.um_per_px = plan.um_per_px;
  const BurnPlan renewed = validatedAgain(arguments, plan, map);
  const Targets lost = lostIn(renewed, plan);
  writeResults(arguments, renewed, map);
  if (!arguments.quiet) report(arguments, plan, renewed, lost);
  if (lost.empty()) return;
  throw std::runtime_error(fmt::format("{}: {} of {} targets became invalid: {}", arguments.check, lost.size(),
                                       validTargets(plan), idsOf(lost)));
}

}  // namespace eyeslam::apps
