// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/wish_commands.h"

#include <gtest/gtest.h>

namespace eyeslam::apps {
namespace {

using messaging::FixtureKind;
using messaging::OperatorWish;
using messaging::WantedMode;

const Sight kSight{7, Eigen::Vector2d(410.5, 290.25)};

OperatorWish after(std::initializer_list<const char*> lines, const Sight& sight = kSight)
{
  OperatorWish wish;
  for (const char* line : lines) EXPECT_TRUE(obeyWish(CommandWords(line), sight, wish)) << line;
  return wish;
}

TEST(WishCommands, ChangeTheMode)
{
  EXPECT_EQ(after({"ready"}).mode, WantedMode::ready);
  EXPECT_EQ(after({"assist"}).mode, WantedMode::assist);
  EXPECT_EQ(after({"laser"}).mode, WantedMode::laser);
  EXPECT_EQ(after({"laser", "  standby  # enough"}).mode, WantedMode::standby);
}

TEST(WishCommands, ChooseAFixtureOfTheMapThatVisionHas)
{
  const OperatorWish point = after({"fixture point 400 -12.5"});
  EXPECT_EQ(point.fixture.kind, FixtureKind::point);
  EXPECT_EQ(point.fixture.point_px, Eigen::Vector2d(400.0, -12.5));
  EXPECT_EQ(point.map_id, 7);
  EXPECT_EQ(after({"fixture point here"}).fixture.point_px, *kSight.tip_px);
  const OperatorWish vessel = after({"fixture vessel 12"});
  EXPECT_EQ(vessel.fixture.kind, FixtureKind::vessel);
  EXPECT_EQ(vessel.fixture.vessel, 12);
  EXPECT_DOUBLE_EQ(after({"fixture standoff 500"}).fixture.standoff, 500e-6);
  EXPECT_EQ(after({"fixture scaling"}).fixture.kind, FixtureKind::scaling);
}

TEST(WishCommands, NameAVesselByAPlaceOfTheMap)
{
  const OperatorWish there = after({"lambda 0.1", "fixture vessel 9", "fixture vessel 400.5 -12"});
  EXPECT_EQ(there.fixture.kind, FixtureKind::vessel);
  EXPECT_EQ(there.fixture.vessel, -1);
  EXPECT_EQ(there.fixture.point_px, Eigen::Vector2d(400.5, -12.0));
  EXPECT_EQ(there.fixture.lambda, 0.1);
  EXPECT_EQ(there.map_id, 7);
  EXPECT_EQ(after({"fixture vessel here"}).fixture.point_px, *kSight.tip_px);
  const OperatorWish by_id = after({"fixture vessel here", "fixture vessel 12"});
  EXPECT_EQ(by_id.fixture.vessel, 12);
  EXPECT_EQ(by_id.fixture.point_px, Eigen::Vector2d::Zero());
  OperatorWish wish;
  EXPECT_EQ(*obeyWish(CommandWords("fixture vessel 4 5"), kSight, wish), "fixture: vessel at 4.0 5.0 px of the map");
  for (const char* line : {"fixture vessel", "fixture vessel -1", "fixture vessel 1.5", "fixture vessel 1 2 3",
                           "fixture vessel here 2", "fixture vessel 1 here", "fixture vessel 1 2e9"}) {
    EXPECT_THROW(obeyWish(CommandWords(line), kSight, wish), CommandError) << line;
  }
  EXPECT_THROW(obeyWish(CommandWords("fixture vessel here"), Sight{7, std::nullopt}, wish), CommandError);
  EXPECT_THROW(obeyWish(CommandWords("fixture vessel 1 2"), Sight{}, wish), CommandError);
}

TEST(WishCommands, LeaveNothingOfTheFixtureBeforeButLambda)
{
  const OperatorWish wish = after({"lambda 0.2", "fixture point 1 2", "fixture vessel 3", "fixture filter"});
  EXPECT_EQ(wish.fixture.vessel, -1);
  EXPECT_EQ(wish.fixture.point_px, Eigen::Vector2d::Zero());
  EXPECT_EQ(wish.fixture.lambda, 0.2);
}

TEST(WishCommands, CalibrateByAFixtureOfItsOwn)
{
  const OperatorWish wish = after({"fixture point 1 2", "calibrate"});
  EXPECT_EQ(wish.mode, WantedMode::assist);
  EXPECT_EQ(wish.fixture.kind, FixtureKind::calibration);
  EXPECT_EQ(wish.fixture.point_px, Eigen::Vector2d::Zero());
}

TEST(WishCommands, NeedNewWishesAfterAStop)
{
  OperatorWish wish;
  wish.plan_approved = true;
  for (const char* line : {"laser", "arm", "stop"}) obeyWish(CommandWords(line), kSight, wish);
  EXPECT_TRUE(wish.stop);
  EXPECT_FALSE(wish.arm);
  obeyWish(CommandWords("rearm"), kSight, wish);
  EXPECT_FALSE(wish.stop);
  EXPECT_EQ(wish.rearmed, 1);
  EXPECT_EQ(wish.mode, WantedMode::ready) << "a stop that was lifted must not start anything";
  EXPECT_FALSE(wish.arm);
}

TEST(WishCommands, DisarmWhoeverLeavesTheLaser)
{
  OperatorWish wish;
  wish.plan_approved = true;
  for (const char* line : {"laser", "arm", "assist", "laser"}) obeyWish(CommandWords(line), kSight, wish);
  EXPECT_FALSE(wish.arm);
}

TEST(WishCommands, DrawZonesAndRemoveThem)
{
  const OperatorWish wish = after({"zone 0 0 10 0 10 20", "zone 5 5 9 5 9 9 5 9"});
  EXPECT_EQ(wish.zones, 2);
  EXPECT_EQ(wish.zone[0].corners, 3);
  EXPECT_EQ(wish.zone[0].corner_px(1, 2), 20.0F);
  EXPECT_EQ(wish.zone[1].corners, 4);
  EXPECT_EQ(wish.map_id, 7);
  EXPECT_EQ(after({"zone 0 0 10 0 10 20", "zone none"}).zones, 0);
}

TEST(WishCommands, AreNotOtherCommands)
{
  OperatorWish wish;
  EXPECT_FALSE(obeyWish(CommandWords("status"), kSight, wish));
  EXPECT_FALSE(obeyWish(CommandWords(""), kSight, wish));
}

class Refusals : public testing::TestWithParam<const char*> {};

// Whatever is refused changes nothing: the message that goes out next is the one before.
TEST_P(Refusals, ChangeNothing)
{
  OperatorWish wish = after({"fixture point 1 2", "zone 0 0 10 0 10 20"});
  EXPECT_THROW(obeyWish(CommandWords(GetParam()), kSight, wish), CommandError);
  EXPECT_EQ(wish.mode, WantedMode::standby);
  EXPECT_EQ(wish.fixture.kind, FixtureKind::point);
  EXPECT_EQ(wish.fixture.point_px, Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(wish.fixture.lambda, 0.0);
  EXPECT_EQ(wish.zones, 1);
  EXPECT_FALSE(wish.arm);
}
INSTANTIATE_TEST_SUITE_P(Lines, Refusals,
                         testing::Values("ready now", "fixture", "fixture magic", "fixture point", "fixture point 1",
                                         "fixture point x 2", "fixture point 1 nan", "fixture point 1 1e9",
                                         "fixture point 1 2 3", "fixture point here 3", "fixture vessel",
                                         "fixture vessel -1", "fixture vessel 1.5", "fixture vessel 1 x",
                                         "fixture vessel 1 2 3", "fixture standoff -1", "fixture standoff 30000",
                                         "fixture filter 3", "lambda", "lambda 2", "lambda -0.1", "lambda x", "zone",
                                         "zone 1 2 3 4", "zone 1 2 3 4 5", "zone 1 2 3 4 5 x", "arm"));

TEST(WishCommands, NeedAMapForPlacesOnIt)
{
  OperatorWish wish;
  const Sight none;
  for (const char* line : {"fixture point 1 2", "fixture point here", "fixture vessel 1", "zone 0 0 10 0 10 20"}) {
    EXPECT_THROW(obeyWish(CommandWords(line), none, wish), CommandError) << line;
  }
  EXPECT_THROW(obeyWish(CommandWords("fixture point here"), {7, std::nullopt}, wish), CommandError);
}

TEST(WishCommands, ArmOnlyTheLaserWithAnApprovedPlan)
{
  OperatorWish wish;
  obeyWish(CommandWords("laser"), kSight, wish);
  EXPECT_THROW(obeyWish(CommandWords("arm"), kSight, wish), CommandError);
  wish.plan_approved = true;
  obeyWish(CommandWords("arm"), kSight, wish);
  EXPECT_TRUE(wish.arm);
}

}  // namespace
}  // namespace eyeslam::apps
