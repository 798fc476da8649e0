// SPDX-License-Identifier: GPL-3.0-or-later
// Which targets of a plan are burnt: the newest map, zones, other plans, reach.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "eyeslam/servo/burn_run.h"
#include "support/burn_scene.h"

using namespace eyeslam;
using namespace eyeslam::servo;
using retina::Reason;
using support::BurnScene;
using support::linePlan;

TEST(BurnRunTargets, TargetsThatTheNewestMapRefusesAreLeftOutWithItsReason)
{
  BurnScene scene(linePlan(4));
  scene.prepared->verdicts[1].reason = Reason::near_vessel;
  scene.prepared->verdicts[2].clearance = 99e-6;  // allowed by the plan's margin, not by the interlock
  scene.run_ms(3000);
  EXPECT_EQ(scene.laser.pulses, (std::vector<int>{10, 13}));
  burn_plan_t message{};
  ASSERT_TRUE(scene.run->ledger().describe(*scene.prepared, message));
  EXPECT_EQ(message.target[1].state, burn_target_t::REFUSED);
  EXPECT_EQ(message.target[1].reason, static_cast<int>(Reason::near_vessel));
  EXPECT_EQ(message.target[0].state, burn_target_t::DONE);
}

TEST(BurnRunTargets, ATargetThatBecomesInvalidWhileTheBeamIsOnItsWayIsNotBurnt)
{
  BurnScene scene(linePlan(2));
  while (scene.step().target != 10) {
  }
  scene.run_ms(50);
  scene.prepared->verdicts[0].reason = Reason::near_vessel;
  scene.run_ms(2000);
  EXPECT_EQ(scene.laser.pulses, (std::vector<int>{11}));
}

TEST(BurnRunTargets, ADrawnZoneWithTheBurnsOwnSizeAndMarginKeepsTargetsOut)
{
  BurnScene scene(linePlan(3));
  // Around the second target's place (60, 20) px: its edge 30 px = 150 um from the target, burn and margin are 160 um.
  scene.wish.zones = 1;
  scene.wish.zone[0].corners = 3;
  scene.wish.zone[0].corner_px.leftCols<3>() << 50.F, 70.F, 60.F, 50.F, 50.F, 90.F;
  scene.run_ms(3000);
  EXPECT_EQ(scene.laser.pulses, (std::vector<int>{10, 12}));
}

TEST(BurnRunTargets, ZonesOfAnotherMapForbidAllPulses)
{
  BurnScene scene(linePlan(1));
  scene.wish.zones = 1;
  scene.wish.zone[0].corners = 3;
  scene.wish.zone[0].corner_px.leftCols<3>() << 500.F, 700.F, 600.F, 500.F, 500.F, 900.F;
  scene.wish.map_id = support::kMap + 1;
  scene.run_ms(1500);
  EXPECT_TRUE(scene.laser.pulses.empty());
  scene.wish.map_id = support::kMap;
  scene.run_ms(1500);
  EXPECT_EQ(scene.laser.pulses.size(), 1U);
}

TEST(BurnRunTargets, AnotherPlanDoesNotBurnWhatThisOneHasBurnt)
{
  BurnScene scene(linePlan(2));
  scene.run_ms(2000);
  ASSERT_EQ(scene.laser.pulses.size(), 2U);
  fixtures::BurnPlan other = linePlan(3);
  for (fixtures::BurnTarget& target : other.targets) {
    target.id += 100;
    target.position_px.x() += 5.0;  // 25 um beside the burns of the first plan, whose radius is 50 um
  }
  scene.prepared = support::preparedFor(other);
  scene.wish.plan_hash = scene.prepared->proposed.hash;
  scene.run_ms(3000);
  EXPECT_EQ(scene.laser.pulses, (std::vector<int>{10, 11, 112}));
  EXPECT_EQ(scene.run->ledger().at(0).reason, Reason::target_burnt);
}

TEST(BurnRunTargets, APlanThatIsProposedAsHalfBurntGoesOnWhereItWas)
{
  fixtures::BurnPlan plan = linePlan(3);
  BurnScene scene(plan);
  burn_plan_t message = planMessage(plan, support::kMap);
  message.target[0].state = burn_target_t::DONE;
  message.target[1].state = burn_target_t::MISSED;
  EXPECT_EQ(planHash(message), scene.prepared->proposed.hash);  // states are no part of it
  scene.prepared->proposed.message = std::make_shared<const burn_plan_t>(message);
  scene.run_ms(3000);
  EXPECT_EQ(scene.laser.pulses, (std::vector<int>{12}));
}

TEST(BurnRunTargets, ATargetOutOfReachIsLeftForLater)
{
  BurnScene scene(linePlan(3));
  const auto far = [](BurnInput& in) { in.null.x() = 1.3e-3; };  // the first target's tip is 1.89 mm away
  for (int i = 0; i < 3000; ++i) scene.step(far);
  EXPECT_EQ(scene.laser.pulses, (std::vector<int>{11, 12}));
  EXPECT_EQ(scene.step(far).reason, Reason::reach_ends);
  EXPECT_FALSE(scene.step(far).goal);  // the tip follows the hand, which must come nearer
  scene.run_ms(1500);
  EXPECT_EQ(scene.laser.pulses.back(), 10);
}

TEST(BurnRunTargets, NoTipGoesOutOfThePicture)
{
  BurnScene scene(linePlan(3));
  // The target is 0 from the retina's left edge, its tip 0.59 mm to the left of it: 60 um from the picture's border.
  const auto aside = [](BurnInput& in) { in.view.view_T_retina.x = 0.65e-3; };
  for (int i = 0; i < 3000; ++i) scene.step(aside);
  EXPECT_EQ(scene.laser.pulses, (std::vector<int>{11, 12}));
  EXPECT_EQ(scene.step(aside).reason, Reason::out_of_view);
  EXPECT_FALSE(scene.step(aside).goal);
  scene.run_ms(1500);  // the eye has moved
  EXPECT_EQ(scene.laser.pulses.back(), 10);
}

TEST(BurnRunTargets, WhereThePictureLeavesTheTargetTheNextOneIsBurntFirst)
{
  BurnScene scene(linePlan(2));
  scene.run_ms(20);  // on the way to the first
  const auto aside = [](BurnInput& in) {
    in.view.view_T_retina.x = 0.65e-3;
    if (in.spot && in.spot->x() < 100e-6) in.spot.reset();
  };
  for (int i = 0; i < 1500; ++i) scene.step(aside);
  EXPECT_EQ(scene.laser.pulses, (std::vector<int>{11}));
  scene.run_ms(1500);
  EXPECT_EQ(scene.laser.pulses, (std::vector<int>{11, 10}));
}
