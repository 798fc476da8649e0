// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/preparation.h"

#include <gtest/gtest.h>

#include <memory>

#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/servo/plan_messages.h"
#include "support/burn_scene.h"
#include "support/planning_maps.h"

using namespace eyeslam;
using namespace eyeslam::servo;
using retina::Reason;

namespace {

constexpr std::int64_t kSecond = 1'000'000;

/// One who maps and one who plans, and the desk that hears both.
class Desk {
 public:
  Desk()
  {
    map = support::emptyMap(300, 200, 2.0, 5.0);
    map.version = 1;
    support::drawVessel(map, {20.0, 40.0}, {280.0, 60.0}, 4.0);
  }

  void sendMap(int tiles = 1'000'000)
  {
    messaging::MapTileCycle cycle;
    vessel_map_t tile{};
    for (int i = 0; i < std::min(tiles, messaging::MapTileCycle::tiles(map)); ++i) {
      ASSERT_TRUE(cycle.next(map, map_id, utime_, tile));
      tiles_.publish(tile, utime_);
    }
  }
  void sendPlan(burn_plan_t plan)
  {
    plan.utime = utime_;
    plans_.publish(plan, utime_);
  }
  bool work(std::int64_t passed = kSecond)
  {
    link_.drain({utime_, utime_});
    utime_ += passed;
    return desk.work({utime_, utime_});
  }
  const Preparation& newest() const { return *desk.newest(); }

  /// Two targets that the map allows, one 60 um beside the vessel.
  static fixtures::BurnPlan plan()
  {
    fixtures::BurnPlan plan = support::linePlan(3);
    plan.targets[0].position_px = {200.0, 250.0};
    plan.targets[1].position_px = {300.0, 100.0};
    plan.targets[2].position_px = {400.0, 250.0};
    return plan;
  }

  retina::VesselMap map;
  std::int64_t map_id = support::kMap;

 private:
  messaging::Link link_{"memq://", 5, std::nullopt};
  messaging::Publisher<vessel_map_t> tiles_{link_};
  messaging::Publisher<burn_plan_t> plans_{link_};
  std::int64_t utime_ = support::kBurnStart;

 public:
  PreparationDesk desk{{}, link_};
};

}  // namespace

TEST(PreparationDesk, MakesVesselsOfTheRetinaFrameFromTheTilesOfAMap)
{
  Desk world;
  EXPECT_FALSE(world.work());
  EXPECT_EQ(world.newest().map_id, 0);
  world.sendMap();
  ASSERT_TRUE(world.work());
  EXPECT_EQ(world.newest().map_id, support::kMap);
  EXPECT_EQ(world.newest().map_version, 1);
  ASSERT_TRUE(world.newest().vessels);
  ASSERT_EQ(world.newest().vessels->vesselCount(), 1);
  // Cell (150, 50) lies on the vessel: map px origin + 2 x cell, m by 5 um per px.
  const Eigen::Vector2d place = 5e-6 * (Eigen::Vector2d(0.5, -20.25) + 2.0 * Eigen::Vector2d(150.0, 50.0));
  const auto nearest = world.newest().vessels->nearest(place, 500e-6);
  ASSERT_TRUE(nearest);
  EXPECT_LT(nearest->distance, 10e-6);  // a cell
}

TEST(PreparationDesk, WaitsUntilAMapIsWhole)
{
  Desk world;
  world.sendMap(100);
  EXPECT_FALSE(world.work());
  world.sendMap();
  EXPECT_TRUE(world.work());
}

TEST(PreparationDesk, AMapThatChangesIsTakenInNoMoreOftenThanAsked)
{
  Desk world;
  world.sendMap();
  ASSERT_TRUE(world.work());
  ++world.map.version;
  world.sendMap();
  EXPECT_FALSE(world.work(200'000));
  EXPECT_TRUE(world.work(300'000));
  EXPECT_EQ(world.newest().map_version, 2);
  EXPECT_FALSE(world.work());  // nothing new
}

TEST(PreparationDesk, VesselsKeepTheirIdsWhenTheMapGrows)
{
  Desk world;
  world.sendMap();
  world.work();
  const int id = world.newest().vessels->id(0);
  const auto old = world.desk.newest();
  support::drawVessel(world.map, {20.0, 120.0}, {280.0, 150.0}, 4.0);
  ++world.map.version;
  world.sendMap();
  ASSERT_TRUE(world.work());
  EXPECT_EQ(world.newest().vessels->vesselCount(), 2);
  EXPECT_GE(world.newest().vessels->find(id), 0);
  EXPECT_EQ(old->vessels->vesselCount(), 1);  // who still uses the old one is not disturbed
}

TEST(PreparationDesk, AnotherMapBeginsAnew)
{
  Desk world;
  world.sendMap();
  world.work();
  ++world.map_id;
  world.sendMap(10);
  EXPECT_FALSE(world.work());
  EXPECT_EQ(world.newest().map_id, support::kMap);
  world.sendMap();
  EXPECT_TRUE(world.work());
  EXPECT_EQ(world.newest().map_id, support::kMap + 1);
}

TEST(PreparationDesk, JudgesEachTargetAgainstTheNewestMap)
{
  Desk world;
  world.sendPlan(planMessage(Desk::plan(), support::kMap));
  world.sendMap();
  ASSERT_TRUE(world.work());
  ASSERT_EQ(world.newest().plan_reason, Reason::none);
  ASSERT_EQ(world.newest().verdicts.size(), 3U);
  EXPECT_EQ(world.newest().verdicts[0].reason, Reason::none);
  EXPECT_EQ(world.newest().verdicts[1].reason, Reason::near_vessel);
  EXPECT_EQ(world.newest().verdicts[2].reason, Reason::none);
  EXPECT_GT(world.newest().verdicts[0].clearance, 100e-6);
  // A vessel appears under the last one.
  support::drawVessel(world.map, {180.0, 130.0}, {220.0, 140.0}, 3.0);
  ++world.map.version;
  world.sendMap();
  ASSERT_TRUE(world.work());
  EXPECT_EQ(world.newest().verdicts[0].reason, Reason::none);
  EXPECT_EQ(world.newest().verdicts[2].reason, Reason::near_vessel);
  EXPECT_LT(world.newest().verdicts[2].clearance, 0.0);
}

// The zones that refused it do not travel, so the map alone would allow it.
TEST(PreparationDesk, WhatWasRefusedWhenItWasProposedStaysRefused)
{
  Desk world;
  fixtures::BurnPlan plan = Desk::plan();
  plan.targets[2].reason = Reason::near_fovea;
  world.sendPlan(planMessage(plan, support::kMap));
  world.sendMap();
  world.work();
  EXPECT_EQ(world.newest().verdicts[2].reason, Reason::near_fovea);
}

TEST(PreparationDesk, APlanOfAnotherMapOrScaleIsNotForThisOne)
{
  Desk world;
  world.sendMap();
  world.sendPlan(planMessage(Desk::plan(), support::kMap + 1));
  world.work();
  EXPECT_EQ(world.newest().plan_reason, Reason::map_changed);
  EXPECT_TRUE(world.newest().verdicts.empty());
  for (const auto& [share, expected] :
       {std::pair{1.029, Reason::none}, {1.031, Reason::plan_scale}, {0.969, Reason::plan_scale}}) {
    fixtures::BurnPlan plan = Desk::plan();
    plan.um_per_px = share * 5.0;
    world.sendPlan(planMessage(plan, support::kMap));
    ASSERT_TRUE(world.work());
    EXPECT_EQ(world.newest().plan_reason, expected) << share;
  }
}

TEST(PreparationDesk, APlanWhoseHashIsNotItsOwnIsNotTaken)
{
  Desk world;
  world.sendMap();
  burn_plan_t forged = planMessage(Desk::plan(), support::kMap);
  forged.target[0].x_px += 30.0;
  world.sendPlan(forged);
  world.work();
  EXPECT_FALSE(world.newest().proposed.plan);
  burn_plan_t twice = planMessage(Desk::plan(), support::kMap);
  twice.target[1].id = twice.target[0].id;
  const messaging::Hash hash = planHash(twice);
  std::copy(hash.begin(), hash.end(), twice.hash);
  world.sendPlan(twice);
  world.work();
  EXPECT_FALSE(world.newest().proposed.plan);
  EXPECT_EQ(world.desk.refused(), 2);
}

TEST(PreparationDesk, APlanThatIsSaidAgainAndTheServosOwnWordChangeNothing)
{
  Desk world;
  world.sendMap();
  const burn_plan_t plan = planMessage(Desk::plan(), support::kMap);
  world.sendPlan(plan);
  ASSERT_TRUE(world.work());
  world.sendPlan(plan);
  EXPECT_FALSE(world.work());
  burn_plan_t in_force = planMessage(support::linePlan(1), support::kMap);
  in_force.state = burn_plan_t::IN_FORCE;
  world.sendPlan(in_force);
  EXPECT_FALSE(world.work());
}

TEST(PreparationDesk, ItsScaleStandsStillWhileTheMapsOwnHardlyChanges)
{
  Desk world;
  world.sendMap();
  world.work();
  for (const auto& [um_per_px, expected] : {std::pair{5.1, 5.0}, {4.9, 5.0}, {5.2, 5.2}, {5.1, 5.2}}) {
    world.map.um_per_px = um_per_px;
    ++world.map.version;
    world.sendMap();
    ASSERT_TRUE(world.work());
    EXPECT_EQ(world.newest().um_per_px, expected);
  }
}

TEST(PreparationDesk, WithoutAScaleThereAreNoVesselsAndNoPlan)
{
  Desk world;
  world.map.um_per_px = 0.0;
  world.sendMap();
  world.sendPlan(planMessage(Desk::plan(), support::kMap));
  ASSERT_TRUE(world.work());
  EXPECT_FALSE(world.newest().vessels);
  EXPECT_EQ(world.newest().plan_reason, Reason::plan_not_in_force);
}
