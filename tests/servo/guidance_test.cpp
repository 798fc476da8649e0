// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/guidance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

using namespace eyeslam;
using messaging::FixtureKind;
using messaging::OperatorWish;
using retina::Reason;
using servo::Guidance;
using servo::Outlook;
using servo::Preparation;

namespace {

constexpr double kUmPerPx = 5.0;
constexpr double kM_per_px = 1e-6 * kUmPerPx;
constexpr std::int64_t kMap = 7;

OperatorWish wishFor(FixtureKind kind)
{
  OperatorWish wish;
  wish.map_id = kMap;
  wish.fixture.kind = kind;
  return wish;
}

OperatorWish pointAt(double x_px, double y_px, double lambda = 0.0)
{
  OperatorWish wish = wishFor(FixtureKind::point);
  wish.fixture.point_px = {x_px, y_px};
  wish.fixture.lambda = lambda;
  return wish;
}

OperatorWish vesselOf(std::int64_t id)
{
  OperatorWish wish = wishFor(FixtureKind::vessel);
  wish.fixture.vessel = id;
  return wish;
}

/// A vessel along x at y = 100 px.
std::shared_ptr<Preparation> preparation(int id = 3)
{
  fixtures::Vessel vessel;
  vessel.id = id;
  for (int x = 0; x <= 1000; x += 10) {
    fixtures::CenterlinePoint point;
    point.position_px = {static_cast<double>(x), 100.0};
    point.tangent = Eigen::Vector2d::UnitX();
    point.s_px = x;
    point.radius_px = 10.0;
    vessel.points.push_back(point);
  }
  auto made = std::make_shared<Preparation>();
  made->map_id = kMap;
  made->um_per_px = kUmPerPx;
  made->vessels = std::make_shared<const fixtures::CenterlineIndex>(std::vector<fixtures::Vessel>{vessel}, kUmPerPx);
  return made;
}

/// A guidance and a hand that holds still.
class Guided : public ::testing::Test {
 protected:
  Eigen::Vector3d after(const OperatorWish& wish, const Eigen::Vector2d& hand_px, int cycles = 3000,
                        double height = 1e-3)
  {
    Eigen::Vector3d goal = Eigen::Vector3d::Zero();
    for (int i = 0; i < cycles; ++i) {
      reason = guidance.serve(wish, frame);
      guidance.engage(Guidance::Engaged::yes);
      goal = step(hand_px, height);
    }
    return goal;
  }
  Eigen::Vector3d step(const Eigen::Vector2d& hand_px, double height = 1e-3)
  {
    Outlook outlook;
    outlook.step_s = 1e-3;
    outlook.null_retina << kM_per_px * hand_px, -height;
    outlook.reason = Reason::none;
    return guidance.goal(outlook);
  }
  static Eigen::Vector2d pxOf(const Eigen::Vector3d& goal) { return goal.head<2>() / kM_per_px; }

  Guidance guidance{servo::GuidanceOptions{}};
  servo::RetinaFrame frame{kMap, kUmPerPx};
  Reason reason = Reason::none;
};

TEST_F(Guided, APointHoldsTheTipOverItAtTheHandsHeight)
{
  const Eigen::Vector3d goal = after(pointAt(200.0, 100.0), {300.0, 150.0});
  EXPECT_EQ(reason, Reason::none);
  EXPECT_LT((pxOf(goal) - Eigen::Vector2d(200.0, 100.0)).norm(), 0.1);
  EXPECT_NEAR(goal.z(), -1e-3, 1e-6);
}

// Before a camera is registered places are in another frame; what was a place there must not be travelled from.
TEST_F(Guided, AViewPlacedAnewForgetsPlacesFromBefore)
{
  after(pointAt(200.0, 100.0), {12000.0, 9000.0});
  ++frame.view;
  const Eigen::Vector3d goal = after(pointAt(200.0, 100.0), {300.0, 150.0}, 1);
  EXPECT_LT((pxOf(goal) - Eigen::Vector2d(300.0, 150.0)).norm(), 1.0) << "it begins at the hand";
  EXPECT_LT((pxOf(after(pointAt(200.0, 100.0), {300.0, 150.0}, 500)) - Eigen::Vector2d(200.0, 100.0)).norm(), 1.0);
}

TEST_F(Guided, LambdaLeavesTheHandItsShare)
{
  const Eigen::Vector3d goal = after(pointAt(200.0, 100.0, 0.2), {300.0, 100.0});  // 500 um from it
  EXPECT_NEAR(pxOf(goal).x(), 220.0, 0.2);
}

TEST_F(Guided, AStandoffHoldsTheHeight)
{
  OperatorWish wish = wishFor(FixtureKind::standoff);
  wish.fixture.standoff = 600e-6;
  EXPECT_NEAR(after(wish, {300.0, 100.0}).z(), -600e-6, 1e-6);
  EXPECT_NEAR(after(wish, {300.0, 100.0}, 3000, 200e-6).z(), -600e-6, 1e-6);
}

TEST_F(Guided, AFloorMayBeRisenFrom)
{
  servo::GuidanceOptions options;
  options.standoff_side = "floor";
  guidance = Guidance(options);
  OperatorWish wish = wishFor(FixtureKind::standoff);
  wish.fixture.standoff = 600e-6;
  EXPECT_NEAR(after(wish, {300.0, 100.0}).z(), -1e-3, 2e-6);
  EXPECT_NEAR(after(wish, {300.0, 100.0}, 3000, 200e-6).z(), -600e-6, 1e-6);
}

TEST_F(Guided, AVesselOfThePreparedMapIsFollowed)
{
  const auto prepared = preparation();
  guidance.adopt(prepared.get());
  const Eigen::Vector3d goal = after(vesselOf(3), {400.0, 140.0});
  EXPECT_EQ(reason, Reason::none);
  EXPECT_NEAR(pxOf(goal).y(), 100.0, 0.1);
  EXPECT_NEAR(pxOf(goal).x(), 400.0, 1.0);
}

TEST_F(Guided, AVesselThatIsNotThereIsRefusedByName)
{
  after(vesselOf(3), {400.0, 140.0}, 1);
  EXPECT_EQ(reason, Reason::no_vessel);
  const auto prepared = preparation();
  guidance.adopt(prepared.get());
  after(vesselOf(4), {400.0, 140.0}, 1);
  EXPECT_EQ(reason, Reason::vessel_unknown);
  after(vesselOf(std::int64_t{1} << 40), {400.0, 140.0}, 1);
  EXPECT_EQ(reason, Reason::vessel_unknown);
}

OperatorWish vesselNear(double x_px, double y_px)
{
  OperatorWish wish = wishFor(FixtureKind::vessel);
  wish.fixture.point_px = {x_px, y_px};
  return wish;
}

/// Vessel 3 along x at y = 100 px, vessel 5 at y = 160 px.
std::shared_ptr<Preparation> twoVessels()
{
  const auto along = [](int id, double y) {
    fixtures::Vessel vessel;
    vessel.id = id;
    for (int x = 0; x <= 1000; x += 10)
      vessel.points.push_back(
          {{static_cast<double>(x), y}, Eigen::Vector2d::UnitX(), 10.0, static_cast<double>(x), 0.0});
    return vessel;
  };
  auto made = preparation();
  made->vessels = std::make_shared<const fixtures::CenterlineIndex>(
      std::vector<fixtures::Vessel>{along(3, 100.0), along(5, 160.0)}, kUmPerPx);
  return made;
}

TEST_F(Guided, AVesselWithoutIdIsTheOneNearestToThePointWhereverTheHandIs)
{
  const auto prepared = twoVessels();
  guidance.adopt(prepared.get());
  EXPECT_NEAR(pxOf(after(vesselNear(800.0, 140.0), {400.0, 110.0})).y(), 160.0, 0.1);
  EXPECT_EQ(reason, Reason::none);
  EXPECT_NEAR(pxOf(after(vesselNear(100.0, 120.0), {400.0, 150.0})).y(), 100.0, 0.1) << "pointed at anew";
  EXPECT_EQ(reason, Reason::none);
}

TEST_F(Guided, APlaceWithoutAVesselNearIsRefusedByName)
{
  after(vesselNear(400.0, 100.0), {400.0, 140.0}, 1);
  EXPECT_EQ(reason, Reason::no_vessel);
  const auto prepared = twoVessels();
  guidance.adopt(prepared.get());
  after(vesselNear(400.0, 265.0), {400.0, 140.0}, 1);  // 525 um; 500 are near
  EXPECT_EQ(reason, Reason::vessel_unknown);
  after(vesselNear(400.0, 255.0), {400.0, 140.0}, 1);
  EXPECT_EQ(reason, Reason::none);
}

TEST_F(Guided, AVesselThatWasPointedAtMayChangeItsIdInANewerMap)
{
  const auto prepared = preparation();
  guidance.adopt(prepared.get());
  after(vesselNear(400.0, 100.0), {400.0, 140.0});
  const auto newer = preparation(9);
  guidance.adopt(newer.get());
  EXPECT_NEAR(pxOf(after(vesselNear(400.0, 100.0), {450.0, 140.0})).y(), 100.0, 0.1);
  EXPECT_EQ(reason, Reason::none);
}

// 300 um: as far as no hand leans, but nearer to the neighbour.
TEST_F(Guided, AHandThatLeansOverTheNeighbourStaysWithItsVessel)
{
  EXPECT_EQ(servo::GuidanceOptions{}.vessel.keeps_to, "vessel");
  const auto prepared = twoVessels();
  guidance.adopt(prepared.get());
  after(vesselNear(400.0, 100.0), {400.0, 110.0});
  EXPECT_NEAR(pxOf(after(vesselNear(400.0, 100.0), {400.0, 160.0})).y(), 100.0, 0.1);
}

TEST_F(Guided, AVesselThatIsFollowedMayChangeItsIdInANewerMap)
{
  const auto prepared = preparation();
  guidance.adopt(prepared.get());
  after(vesselOf(3), {400.0, 140.0});
  const auto newer = preparation(9);
  guidance.adopt(newer.get());
  const Eigen::Vector3d goal = after(vesselOf(3), {450.0, 140.0});
  EXPECT_EQ(reason, Reason::none);
  EXPECT_NEAR(pxOf(goal).y(), 100.0, 0.1);
}

TEST_F(Guided, WhatSpeaksOfAnotherMapIsRefused)
{
  OperatorWish wish = pointAt(200.0, 100.0);
  wish.map_id = 8;
  after(wish, {300.0, 100.0}, 1);
  EXPECT_EQ(reason, Reason::map_changed);
  wish = wishFor(FixtureKind::standoff);  // speaks of none
  wish.map_id = 8;
  wish.fixture.standoff = 1e-3;
  after(wish, {300.0, 100.0}, 1);
  EXPECT_EQ(reason, Reason::none);
}

TEST_F(Guided, WithoutAScaleNothingIsServed)
{
  frame.um_per_px = 0.0;
  after(wishFor(FixtureKind::filter), {300.0, 100.0}, 1);
  EXPECT_EQ(reason, Reason::scale_unknown);
  after(wishFor(FixtureKind::calibration), {300.0, 100.0}, 1);
  EXPECT_EQ(reason, Reason::none);
  after(wishFor(FixtureKind::none), {300.0, 100.0}, 1);
  EXPECT_EQ(reason, Reason::none);
}

TEST_F(Guided, AZoneIsNotEntered)
{
  OperatorWish wish = wishFor(FixtureKind::filter);
  wish.zones = 1;
  wish.zone[0].corners = 4;
  wish.zone[0].corner_px.leftCols<4>() << 200, 400, 400, 200, 0, 0, 200, 200;
  Eigen::Vector3d goal = after(wish, {100.0, 100.0}, 1000, 300e-6);
  EXPECT_NEAR(pxOf(goal).x(), 100.0, 0.5);
  for (int x = 100; x <= 250; ++x) goal = after(wish, {static_cast<double>(x), 100.0}, 20, 300e-6);
  EXPECT_LE(pxOf(goal).x(), 200.0 - 100.0 / kUmPerPx + 0.1);  // the margin of 100 um is kept
  // Taken away, it gives way.
  goal = after(wishFor(FixtureKind::filter), {250.0, 100.0}, 2000, 300e-6);
  EXPECT_NEAR(pxOf(goal).x(), 250.0, 0.5);
}

TEST_F(Guided, AZoneThatMakesNoSenseIsRefused)
{
  OperatorWish wish = wishFor(FixtureKind::filter);
  wish.zones = 1;
  wish.zone[0].corners = 3;
  wish.zone[0].corner_px.leftCols<3>() << 200, NAN, 400, 0, 0, 200;
  after(wish, {100.0, 100.0}, 1);
  EXPECT_EQ(reason, Reason::zone_invalid);
}

TEST_F(Guided, ScalingIsSlowerNearAVessel)
{
  const auto prepared = preparation();
  guidance.adopt(prepared.get());
  const OperatorWish wish = wishFor(FixtureKind::scaling);
  const double before = pxOf(after(wish, {400.0, 100.0}, 2000)).x();
  for (int i = 0; i <= 40; ++i) after(wish, {400.0 + i, 100.0}, 20);
  const double scaled = pxOf(after(wish, {440.0, 100.0}, 2000)).x() - before;
  EXPECT_NEAR(scaled, 40.0 * servo::GuidanceOptions{}.scaling_least, 2.0);
}

TEST_F(Guided, APointThatMovesIsTravelledTo)
{
  after(pointAt(200.0, 100.0), {200.0, 100.0});
  double last = 200.0, fastest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double x = pxOf(after(pointAt(400.0, 100.0), {200.0, 100.0}, 1)).x();
    fastest = std::max(fastest, (x - last) * kM_per_px / 1e-3);
    last = x;
  }
  EXPECT_NEAR(last, 400.0, 0.1);
  EXPECT_LT(fastest, 5.1e-3);  // m/s, of the travel
}

TEST_F(Guided, UntilItIsEngagedTheGoalIsTheHand)
{
  Eigen::Vector3d goal;
  for (int i = 0; i < 2000; ++i) {
    guidance.serve(pointAt(200.0, 100.0), frame);
    guidance.engage(Guidance::Engaged::no);
    goal = step({300.0, 100.0});
  }
  EXPECT_NEAR(pxOf(goal).x(), 300.0, 0.1);
}

TEST_F(Guided, WhenTheRetinaIsLostTheGoalGoesToTheHand)
{
  after(pointAt(200.0, 100.0), {300.0, 100.0});
  Outlook lost;
  lost.step_s = 1e-3;
  lost.null_retina << 300.0 * kM_per_px, 100.0 * kM_per_px, -1e-3;
  lost.reason = Reason::pose_stale;
  Eigen::Vector3d goal;
  for (int i = 0; i < 500; ++i) goal = guidance.goal(lost);
  EXPECT_NEAR(pxOf(goal).x(), 300.0, 0.5);
}

}  // namespace
