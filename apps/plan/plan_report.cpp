// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/plan_report.h"

#include <fmt/format.h>

#include <iterator>

#include "eyeslam/fixtures/burn_order.h"
#include "eyeslam/fixtures/plan_summary.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::apps {
namespace {

constexpr double kSmallDose = 0.5;  // below, a plan is hardly the treatment that was asked for

std::string refusals(const fixtures::PlanSummary& summary)
{
  std::string text;
  for (const auto& [reason, count] : summary.refused) {
    text += fmt::format("{}{} {}", text.empty() ? ": " : ", ", count, retina::word(reason));
  }
  return fmt::format("{}{}", summary.asked - summary.valid, text);
}

std::string rest(const fixtures::BurnOrderOptions& order, const fixtures::PlanTravel& travel)
{
  if (order.rest_um <= 0.0 || order.rest_ms <= 0.0) return "";
  const std::string waits = travel.waits == 0
                                ? std::string("kept by the order alone")
                                : fmt::format("{} waits, {:.1f} s in all", travel.waits, travel.waiting_ms / 1000.0);
  return fmt::format("  rest       {:.0f} ms between burns within {:.0f} um: {}\n", order.rest_ms, order.rest_um,
                     waits);
}

}  // namespace

std::string warningsOf(const fixtures::BurnPlan& plan)
{
  const fixtures::BurnKeepOutOptions& zones = plan.prescription.keep_out;
  const fixtures::PlanSummary summary = fixtures::summarise(plan);
  std::string text;
  if (zones.fovea_px.empty()) text += "warning: fovea unknown: nothing is kept free around it; give --fovea X,Y\n";
  if (zones.disc_px.empty()) text += "warning: optic disc unknown: nothing is kept free around it; give --disc X,Y\n";
  if (summary.placed < kSmallDose) {
    text += fmt::format("warning: only {:.0f} % of the asked dose could be placed\n", 100.0 * summary.placed);
  }
  return text;
}

std::string summaryOf(const fixtures::BurnPlan& plan)
{
  const fixtures::PlanSummary summary = fixtures::summarise(plan);
  const fixtures::PlanTravel travel = fixtures::travelOf(plan);
  const fixtures::BurnPrescription& asked = plan.prescription;
  std::string text;
  const auto to = std::back_inserter(text);
  fmt::format_to(to, "{} targets asked for: {}, burn {:.0f} um, spacing {:.0f} um, {:.3g} um per px\n", summary.asked,
                 asked.pattern.kind, asked.burn_um(), asked.pattern.spacing_um, plan.um_per_px);
  fmt::format_to(to, "  valid      {}, {:.0f} % of the asked dose\n", summary.valid, 100.0 * summary.placed);
  fmt::format_to(to, "  refused    {}\n", refusals(summary));
  if (summary.valid == 0) return text;
  fmt::format_to(to, "  density    {:.2f} per mm2, {:.1f} % of {:.1f} mm2 burnt\n", summary.density_per_mm2,
                 100.0 * summary.coverage, summary.area_mm2);
  fmt::format_to(to, "  clearance  at least {:.0f} um from burn to vessel, {:.0f} um asked\n",
                 summary.least_clearance_um, asked.safety.margin_um + asked.safety.localization_um);
  fmt::format_to(to, "  travel     {:.1f} mm; {} placement{} of the {:.1f} mm workspace\n", travel.travel_mm,
                 travel.tiles.size(), travel.tiles.size() == 1 ? "" : "s", asked.order.reach_um / 1000.0);
  return text + rest(asked.order, travel);
}

}  // namespace eyeslam::apps
