// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/plan_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/retina/sha256.h"
#include "support/burn_scene.h"

using namespace eyeslam;
using namespace eyeslam::servo;
using support::linePlan;

TEST(PlanMessages, APlanSurvivesItsMessage)
{
  fixtures::BurnPlan plan = linePlan(4);
  plan.map.hash = std::string(62, 'a') + "0f";
  plan.prescription.safety.margin_um = 120.0;
  plan.prescription.safety.localization_um = 7.0;
  plan.targets[2].tile = 3;
  plan.targets[3].reason = retina::Reason::near_fovea;
  const fixtures::BurnPlan same = planOf(planMessage(plan, support::kMap));
  EXPECT_EQ(same.um_per_px, plan.um_per_px);
  EXPECT_EQ(same.map.hash, plan.map.hash);
  EXPECT_EQ(same.prescription.safety.margin_um, 120.0);
  EXPECT_EQ(same.prescription.safety.localization_um, 7.0);
  ASSERT_EQ(same.targets.size(), plan.targets.size());
  for (std::size_t i = 0; i < plan.targets.size(); ++i) {
    EXPECT_EQ(same.targets[i].id, plan.targets[i].id);
    EXPECT_EQ(same.targets[i].position_px, plan.targets[i].position_px);
    EXPECT_EQ(same.targets[i].spot_um, plan.targets[i].spot_um);
    EXPECT_EQ(same.targets[i].burn_um, plan.targets[i].burn_um);
    EXPECT_DOUBLE_EQ(same.targets[i].duration_ms, plan.targets[i].duration_ms);
    EXPECT_DOUBLE_EQ(same.targets[i].power_mw, plan.targets[i].power_mw);
    EXPECT_EQ(same.targets[i].tile, plan.targets[i].tile);
    EXPECT_EQ(same.targets[i].reason, plan.targets[i].reason);
    EXPECT_EQ(same.targets[i].clearance_um, plan.targets[i].clearance_um);
  }
}

TEST(PlanMessages, WhateverDecidesWhatIsBurntChangesTheHash)
{
  const burn_plan_t plan = planMessage(linePlan(3), support::kMap);
  const messaging::Hash hash = planHash(plan);
  const std::vector<std::function<void(burn_plan_t&)>> changes{
      [](burn_plan_t& p) { p.um_per_px *= 1.0001; },
      [](burn_plan_t& p) { p.margin_um += 1e-6; },
      [](burn_plan_t& p) { p.localization_um += 1e-6; },
      [](burn_plan_t& p) { ++p.map_id; },
      [](burn_plan_t& p) { p.map_hash[31] ^= 1; },
      [](burn_plan_t& p) { p.target.pop_back(); },
      [](burn_plan_t& p) { std::swap(p.target[0], p.target[1]); },
      [](burn_plan_t& p) { ++p.target[1].id; },
      [](burn_plan_t& p) { ++p.target[1].tile; },
      [](burn_plan_t& p) { p.target[1].x_px += 1e-9; },
      [](burn_plan_t& p) { p.target[1].y_px += 1e-9; },
      [](burn_plan_t& p) { p.target[1].spot_um += 1e-9; },
      [](burn_plan_t& p) { p.target[1].burn_um += 1e-9; },
      [](burn_plan_t& p) { p.target[1].duration *= 2.0; },
      [](burn_plan_t& p) { p.target[1].power *= 2.0; },
      [](burn_plan_t& p) { p.target[1].state = burn_target_t::REFUSED; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    burn_plan_t changed = plan;
    changes[i](changed);
    EXPECT_NE(planHash(changed), hash) << i;
  }
  burn_plan_t executed = plan;
  executed.state = burn_plan_t::IN_FORCE;
  executed.target[0].state = burn_target_t::DONE;
  executed.target[1].state = burn_target_t::MISSED;
  executed.target[1].reason = 24;
  executed.target[2].clearance_um = 3.0;
  EXPECT_EQ(planHash(executed), hash);
}

// So that other programs, in other languages, may calculate it: bytes as documented, hashed by another implementation.
TEST(PlanMessages, TheHashIsTheDocumentedOne)
{
  burn_plan_t plan{};
  plan.um_per_px = 5.0;
  plan.margin_um = 100.0;
  plan.localization_um = 10.0;
  plan.map_id = 77;
  // python3: hashlib.sha256(struct.pack('<dddq32sI', 5, 100, 10, 77, bytes(32), 0)).hexdigest()
  const messaging::Hash hash = planHash(plan);
  EXPECT_EQ(retina::hexOf(hash), "69f554e9b58692785ec9cb5fb2292a1d2548496a08d6964789b2f09f98bea47c");
  plan.target.push_back({});
  burn_target_t& target = plan.target.back();
  target.id = 3;
  target.tile = 1;
  target.x_px = 1.5;
  target.y_px = -2.0;
  target.spot_um = 100.0;
  target.burn_um = 120.0;
  target.duration = 0.02;
  target.power = 0.15;
  // ... + struct.pack('<iiddddddB', 3, 1, 1.5, -2, 100, 120, .02, .15, 0), with 1 target
  EXPECT_EQ(retina::hexOf(planHash(plan)), "0aa371e46a532d28d6f947c08e7aad6937889727cf14cb31ca66c2e17be0a28f");
}

TEST(PlanMessages, WhatNoMessageCarriesIsRefusedByName)
{
  EXPECT_THROW(planMessage(linePlan(messaging::kMostTargets + 1), 1), fixtures::PlanError);
  fixtures::BurnPlan strong = linePlan(1);
  strong.targets[0].power_mw = 10'001.0;
  EXPECT_THROW(planMessage(strong, 1), fixtures::PlanError);
  fixtures::BurnPlan nowhere = linePlan(1);
  nowhere.targets[0].position_px.x() = std::nan("");
  EXPECT_THROW(planMessage(nowhere, 1), fixtures::PlanError);
}
